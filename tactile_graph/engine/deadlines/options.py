"""What of a plan may be left undone when time is short, and who decides about it.

Two things may be: a choice of a ``first_of``, with all that only it needs; and any other node of a
step when its turn comes. The last choice of each ladder, with all that it needs, is spared unless
one before it is much quicker: it is what a frame comes to at the least. So are sinks: what is
written is written whole.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass, field
from typing import Any, Protocol

from tactile_graph.engine.outcomes.outcome import Skipped, for_want_of_time
from tactile_graph.engine.plan import Item, Plan, is_ladder
from tactile_graph.pipeline.graph import Isolation, NodeKind
from tactile_graph.wires.frame import Frame

Work = frozenset[tuple[str, Isolation | None]]


@dataclass(frozen=True, slots=True)
class Option:
    """One thing that may be left undone, or that is spared and only timed.

    Attributes
    ----------
    number : int
    node : str
        Which node is skipped where it is left undone.
    slot : int
        Of the node.
    settles : int
        The slot that is settled once nothing of it is left to do: the node's, or its ladder's.
    spared : bool
        Whether it is done in any case, as long as nothing ``instead`` of it is much quicker.
    always : bool
        Whether every frame comes to it, or to what stands in its place.
    instead : tuple of int
        Numbers of the choices that stand before it in its ladder, where it is the last.
    beneath : int
        How many choices stand after it in its ladder, but for the last.
    work : frozenset
        The nodes that are run with it unless something else has run them before: their keys, and
        in what process they run. Options of equal work take as long, in whatever plan they stand.
    """

    number: int
    node: str
    slot: int
    settles: int
    spared: bool
    always: bool
    instead: tuple[int, ...] = ()
    beneath: int = 0
    work: Work = frozenset()

    @property
    def skipped(self) -> Skipped:
        """The outcome of its node where it is left undone."""
        return Skipped(self.node, for_want_of_time)


@dataclass(frozen=True, slots=True)
class Options:
    """All options of a plan: of nodes by slot, of choices by their ladder's slot and place."""

    nodes: dict[int, Option] = field(default_factory=dict)
    choices: dict[tuple[int, int], Option] = field(default_factory=dict)

    def __iter__(self) -> Any:
        return iter((*self.nodes.values(), *self.choices.values()))

    def __len__(self) -> int:
        return len(self.nodes) + len(self.choices)


class Decider(Protocol):
    """Decides for each frame what of it is left undone."""

    def prepare(self, options: Options) -> None:
        """Take note of what there is to decide about; called before the first frame."""

    def begin(self, frame: Frame) -> None:
        """A frame is begun."""

    def allows(self, option: Option, state: list[Any]) -> bool:
        """Return whether to begin an option."""

    def ended(self, option: Option, state: list[Any]) -> None:
        """Note that an option that was begun has ended."""

    def end(self) -> None:
        """The frame is done."""


def options_of(plan: Plan) -> Options:
    """Return what may be left undone in a plan whose ladders wait."""
    ladders = [i for i in plan.items if is_ladder(i)]
    least = _Reached(plan, through_all=False)
    blocks = _Reached(plan, through_all=True)
    for ladder in ladders:
        least.add([*ladder.guard, *ladder.inputs[-1].slots])
        blocks.add(s for port in ladder.inputs for s in port.slots)
    found, main = Options(), frozenset(plan.main)
    for item in plan.items:
        if _may_wait(item) and (item.slot in main or item.slot not in blocks.slots):
            spared, always = item.slot in least.slots, item.slot in main
            if not spared or always:
                work = _work(plan, item.slot, main)
                found.nodes[item.slot] = Option(
                    len(found), item.name, item.slot, item.slot, spared, always, (), 0, work
                )
    for ladder in ladders:
        _add_choices(found, plan, ladder, least.slots)
    return found


def _add_choices(found: Options, plan: Plan, ladder: Item, least: set[int]) -> None:
    before: list[int] = []
    always = ladder.slot in plan.main
    for place, port in enumerate(ladder.inputs):
        choice = plan.items[port.slots[0]]
        slot = choice.slot if choice.view is None else choice.source
        last = place == len(ladder.inputs) - 1
        if slot == 0 or (slot in least and not last):
            continue  # there at once, or done in any case
        instead = tuple(before) if last else ()
        name, number = plan.items[slot].name, len(found)
        work = _work(plan, slot, frozenset(plan.main))
        beneath = max(len(ladder.inputs) - 2 - place, 0)
        option = Option(number, name, slot, ladder.slot, last, always, instead, beneath, work)
        found.choices[ladder.slot, place] = option
        before.append(number)


def _work(plan: Plan, slot: int, main: frozenset[int]) -> Work:
    """Return what is run with a slot's node: itself, and what it needs that frames may not need."""
    seen, waiting, work = set[int](), [slot], set[tuple[str, Isolation | None]]()
    while waiting:
        item = plan.items[waiting.pop()]
        seen.add(item.slot)
        if item.node is not None:
            work.add((item.node.key, item.node.isolation))
        waiting += [s for s in item.reads if s not in main and s not in seen]
    return frozenset(work)


def _may_wait(item: Item) -> bool:
    node = item.node
    kinds = (NodeKind.STEP, NodeKind.MAP)
    return node is not None and node.kind in kinds and not item.constant and not node.is_sink


class _Reached:
    """The slots that some slots need: of a ladder all choices, or only the last."""

    def __init__(self, plan: Plan, through_all: bool) -> None:
        self._items, self._through_all = plan.items, through_all
        self.slots: set[int] = set()

    def add(self, slots: Iterable[int]) -> None:
        waiting = list(slots)
        while waiting:
            slot = waiting.pop()
            if slot not in self.slots:
                self.slots.add(slot)
                item = self._items[slot]
                if is_ladder(item) and not self._through_all:
                    waiting += [*item.guard, *item.inputs[-1].slots]
                else:
                    waiting += item.reads


class Recorded:
    """Decides as was decided before, so that a frame comes to the same again.

    Set ``skipped`` to the names of the nodes that were skipped for the deadline before each frame.
    """

    def __init__(self, skipped: Collection[str] = ()) -> None:
        self.skipped: Collection[str] = skipped

    def prepare(self, options: Options) -> None:
        """Take no note: what was decided stands."""

    def begin(self, frame: Frame) -> None:
        """Begin a frame."""

    def allows(self, option: Option, state: list[Any]) -> bool:
        """Return whether the option was begun then."""
        return option.node not in self.skipped

    def ended(self, option: Option, state: list[Any]) -> None:
        """Note nothing: time plays no part."""

    def end(self) -> None:
        """End the frame."""
