"""``Block``: what several frames came to, kept by groups of frames that went the same way."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Generic, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from tactile_graph.engine.blocks.stacked import Parted, at, taken
from tactile_graph.engine.outcomes.outcome import Outcome
from tactile_graph.engine.outcomes.outcomes import Outcomes
from tactile_graph.engine.plan import Plan
from tactile_graph.wires.frame_stack import FrameStack
from tactile_graph.wires.stacks import Rows

ResultT = TypeVar("ResultT", bound=Outcomes)
State = list[Any]


@dataclass(frozen=True, slots=True)
class Group:
    """Frames of a block that went the same way, and what they came to, as stacks.

    Parameters
    ----------
    rows : Rows
        Their places in the block.
    state : list
        As of one frame; its values are stacks of these frames, its times those of all together.
    """

    rows: Rows
    state: State

    def part(self, rows: Rows, n_slots: int) -> Group:
        """Return some of the frames, by their places in the group."""
        if len(rows) == len(self.rows):
            return self
        state = self.state
        share = len(rows) / len(self.rows)
        kept = [taken(outcome, rows) for outcome in state[:n_slots]]
        times = [int(time * share) for time in state[n_slots : 2 * n_slots]]
        return Group(self.rows[rows], [*kept, *times, *state[2 * n_slots :]])

    def parts(self, parted: Parted, n_slots: int) -> Iterator[Group]:
        """Yield those that go on together, with what was settled for them."""
        for rows in parted.together:
            group = self.part(rows, n_slots)
            if parted.slot >= 0:
                group = Group(group.rows, group.state.copy())
                group.state[parted.slot] = taken(parted.value, rows)
                group.state[n_slots + parted.slot] = parted.time_ns
            yield group

    def frame_state(self, place: int, n_slots: int) -> State:
        """Return the state of one frame, by its place in the group."""
        state, n = self.state, len(self.rows)
        kept = [at(outcome, place) for outcome in state[:n_slots]]
        times = [time // n for time in state[n_slots : 2 * n_slots]]
        return [*kept, *times, *state[2 * n_slots :]]


class Repeats(NamedTuple):
    """Which frames of a block are the last one's again.

    Attributes
    ----------
    of : ndarray of int, shape (n,)
        For each frame the place of the one whose outcomes it has: its own where it has its own, and
        -1 for the last frame before the block.
    before : Outcomes, optional
        What that came to.
    """

    of: NDArray[np.intp]
    before: Any = None


class Constant(NamedTuple):
    """A slot that depends on no frame, and was first needed by a frame of a block.

    Frames after it have its value, whether they need it or not.
    """

    slot: int
    first_row: int
    value: Outcome


class Block(Sequence[ResultT], Generic[ResultT]):
    """The results of several frames, each made when it is taken.

    Parameters
    ----------
    plan : Plan
    result : type
        What a frame's outcomes are handed out as.
    frames : FrameStack
    groups : sequence of Group
        Of frames that went the same way to the end.
    alone : mapping of int to state
        What the others came to, by their places.
    repeats : Repeats
    constants : sequence of Constant
    """

    def __init__(
        self,
        plan: Plan,
        result: type[ResultT],
        frames: FrameStack,
        groups: Sequence[Group],
        alone: dict[int, State],
        repeats: Repeats,
        constants: Sequence[Constant] = (),
    ) -> None:
        self.plan, self.frames, self.groups, self.alone = plan, frames, groups, alone
        self.repeats, self._constants = repeats, constants
        self._result = result
        self._place = np.full(len(repeats.of), -1)
        self._group = np.full(len(repeats.of), -1)
        for number, group in enumerate(groups):
            self._group[group.rows] = number
            self._place[group.rows] = np.arange(len(group.rows))
        self._made: dict[int, ResultT] = {}

    def __len__(self) -> int:
        return len(self.repeats.of)

    def __getitem__(self, i: Any) -> Any:
        """Return the result of a frame, or of several."""
        if isinstance(i, slice):
            return [self[k] for k in range(*i.indices(len(self)))]
        i = range(len(self))[i]
        of = int(self.repeats.of[i])
        if of == i:
            return self._own(i)
        first: ResultT = self.repeats.before if of < 0 else self._own(of)
        return first.again(self.frames[i])

    def _own(self, i: int) -> ResultT:
        if i not in self._made:
            state = self.alone.get(i)
            if state is None:
                group = self.groups[self._group[i]]
                state = group.frame_state(int(self._place[i]), self.plan.n_slots)
            for slot, first_row, value in self._constants:
                if i >= first_row and state[slot] is None:
                    state[slot] = value
            self._made[i] = self._result(self.plan, state)
        return self._made[i]

    def kinds(self) -> Iterator[ResultT]:
        """Yield a result of each group, and each of the frames that are in none."""
        yield from (self[int(group.rows[0])] for group in self.groups)
        yield from (self[row] for row in self.alone)

    def outcome_of(self, group: Group, name: str) -> Outcome:
        """Return what an output asked for came to for the frames of a group."""
        return group.state[self.plan.asked[name]]

    def together(self) -> Iterator[tuple[Group, Rows]]:
        """Yield each group with the places of its frames and of those that repeat one of them.

        Beside them stand, for each such place, the place in the group: shape (2, n).
        """
        own = self.repeats.of >= 0
        of = np.where(own, self.repeats.of, 0)
        for number, group in enumerate(self.groups):
            rows = np.flatnonzero(own & (self._group[of] == number))
            yield group, np.array([rows, self._place[of[rows]]])


def first_settled(slot: int, groups: Sequence[Group], alone: Mapping[int, State]) -> int:
    """Return the place of the first frame for which a slot is settled."""
    rows = [int(g.rows[0]) for g in groups if g.state[slot] is not None]
    return min([*rows, *(row for row, state in alone.items() if state[slot] is not None)])
