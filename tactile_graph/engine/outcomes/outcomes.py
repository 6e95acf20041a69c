"""``Outcomes``: what a frame came to, node by node, with reasons and times."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple, Self

from tactile_graph.engine.outcomes.notices import notices
from tactile_graph.engine.outcomes.outcome import (
    NO_VALUE,
    NOT_ASKED,
    Failed,
    Outcome,
    Skipped,
    gaps,
)
from tactile_graph.engine.plan import Plan
from tactile_graph.errors import TactileGraphError, UsageError, did_you_mean, one_of
from tactile_graph.pipeline.wiring import Ref
from tactile_graph.wires.frame import Frame

LATER, REUSED, ITEM_FAILURES, INNER = -4, -3, -2, -1
"""Behind the outcomes and times of its slots a state holds what makes those that were left unmade
(each takes the state), whether it is the last frame's again, the failures of single items, and the
results of embedded pipelines."""


def blank_state(n_slots: int) -> list[Any]:
    """Return the state a frame starts from: outcomes, times in nanoseconds, and what is extra."""
    return [None] * n_slots + [0] * n_slots + [(), False, (), None]


class NoResult(TactileGraphError):  # noqa: N818 -- it reads as what it says
    """An output was taken that has no value for this frame."""

    def __init__(self, name: str, outcome: Outcome) -> None:
        super().__init__(name, outcome)
        self.name = name
        self.outcome = outcome

    def __str__(self) -> str:
        outcome = self.outcome
        word = "failed" if isinstance(outcome, Failed) else "was skipped"
        at = f" at {outcome.origin!r}" if outcome.origin and outcome.origin != self.name else ""
        found = isinstance(outcome, Failed) and outcome.kind == "error" and outcome.where
        return f"{self.name!r} {word}{at}: {outcome.reason}" + (f" (at {found})" if found else "")


class Explained(NamedTuple):
    """One node's story for a frame."""

    node: str
    step: str
    state: str
    reason: str
    time_us: float
    value: Any = None


class Outcomes(Mapping[str, Any]):
    """The outcome of one frame; as a mapping, the outputs that have a value."""

    __slots__ = ("_state", "plan")

    def __init__(self, plan: Plan, state: list[Any]) -> None:
        self.plan = plan
        self._state = state

    def __reduce__(self) -> tuple[type[Self], tuple[Plan, list[Any]]]:
        """Pickle with everything made that was left for later."""
        return type(self), (self.plan, self.whole_state)

    @property
    def whole_state(self) -> list[Any]:
        """The state with everything made that was left for later."""
        state = self._state
        for make in state[LATER]:
            make(state)
        state[LATER] = ()  # only now: another thread may ask meanwhile
        return state

    def again(self, frame: Frame) -> Self:
        """Return the same outcomes for an equal frame; they took no time."""
        state = self._state.copy()
        state[0] = frame
        state[REUSED] = True
        return type(self)(self.plan, state)

    @property
    def reused(self) -> bool:
        """Whether the frame was equal to the one before, so that nothing had to run."""
        return self._state[REUSED] is True

    @property
    def frame(self) -> Frame:
        """The frame this is the result of."""
        frame: Frame = self._state[0]
        return frame

    @property
    def inner(self) -> dict[str, list[Self | None]]:
        """For each node that ran a pipeline over a list, the results of its items.

        None stands for an item that had no value itself.
        """
        return self._state[INNER] or {}

    # -- outputs -----------------------------------------------------------------------------

    def __getitem__(self, name: str) -> Any:
        """Return the value of an output or node.

        Raises
        ------
        NoResult
            If it was skipped or failed, with the reason.
        UsageError
            If there is no such node.
        """
        outcome = self.outcome(name)
        if outcome.__class__ in NO_VALUE:
            raise NoResult(name, outcome)
        return outcome

    def get(self, name: str, default: Any = None) -> Any:
        """Return the value of an output or node, or ``default`` where it has none."""
        outcome = self.outcome(name)
        return default if outcome.__class__ in NO_VALUE else outcome

    def __iter__(self) -> Iterator[str]:
        return (n for n in self.plan.asked if self.outcome(n).__class__ not in NO_VALUE)

    def __len__(self) -> int:
        return sum(1 for _ in self)

    def __contains__(self, name: object) -> bool:
        return name in list(self)

    @property
    def outputs(self) -> dict[str, Any]:
        """The outputs that have a value."""
        return {name: self[name] for name in self}

    # -- outcomes ----------------------------------------------------------------------------

    def outcome(self, name: str) -> Outcome:
        """Return a node's or output's value, `Skipped` or `Failed`.

        Raises
        ------
        UsageError
            If the plan has no such node.
        """
        slot = self.plan.asked.get(name, self.plan.slots.get(name))
        if slot is None:
            if name in self.plan.pipeline.nodes:
                return NOT_ASKED
            known = dict.fromkeys((*self.plan.asked, *self.plan.pipeline.nodes))
            hint = did_you_mean(name, known) or f"; there are: {one_of(known)}"
            raise UsageError(f"no node or output named {name!r}{hint}")
        outcome = self._state[slot]
        if outcome is None and self._state[LATER]:
            outcome = self.whole_state[slot]
        return NOT_ASKED if outcome is None else outcome

    def outcome_at(self, ref: Ref) -> Outcome:
        """Return the outcome of what the plan reads at a reference."""
        slot = self.plan.refs.get(ref)
        outcome = None if slot is None else self._state[slot]
        if slot is not None and outcome is None and self._state[LATER]:
            outcome = self.whole_state[slot]
        return NOT_ASKED if outcome is None else outcome

    @property
    def outcomes(self) -> dict[str, Outcome]:
        """The outcome of every node of the pipeline, in the order of the file."""
        return {name: self.outcome(name) for name in self.plan.pipeline.nodes}

    @property
    def times_us(self) -> dict[str, float]:
        """Microseconds each node's step took; 0 where it did not run."""
        n, reused = self.plan.n_slots, self.reused
        return {i.name: 0.0 if reused else self._state[n + i.slot] / 1e3 for i in self.plan.nodes}

    @property
    def failures(self) -> list[Failed]:
        """The failures of this frame, each once, those of single items of a list included."""
        within = [
            failed.within(node, i)
            for node, results in self.inner.items()
            for i, result in enumerate(results)
            if result is not None
            for failed in result.failures
        ]
        outcomes = [self._state[item.slot] for item in self.plan.items]
        found = [*outcomes, *self._state[ITEM_FAILURES], *within]
        failed = [f for f in found if f.__class__ is Failed]
        return list({(f.origin, f.item, id(f.error)): f for f in failed}.values())

    @property
    def gaps(self) -> dict[str, list[Skipped | Failed]]:
        """For each output whose list lacks items, the outcomes that stand in their places."""
        found = {name: gaps(self.outcome(name)) for name in self.plan.asked}
        return {name: empty for name, empty in found.items() if empty}

    @property
    def notices(self) -> dict[str, str]:
        """What steps say of this frame beside their values, by node; worked out on each asking."""
        return {node: text for node, text in notices(self).items() if text}

    @property
    def decisions(self) -> tuple[str, ...]:
        """The nodes that were skipped to keep the deadline, in the order of the plan."""
        outcomes = [(item.name, self._state[item.slot]) for item in self.plan.nodes]
        return tuple(
            name
            for name, outcome in outcomes
            if outcome.__class__ is Skipped and outcome.origin == name and outcome.for_deadline
        )

    @property
    def ok(self) -> bool:
        """Whether every output asked for has a value, and every item of its lists."""
        return len(self) == len(self.plan.asked) and not self.gaps

    def explain(self) -> list[Explained]:
        """Return for each node whether it ran, was skipped or failed, why, and how long it took."""
        times = self.times_us
        return [self._story(name, times.get(name, 0.0)) for name in self.plan.pipeline.nodes]

    def _story(self, name: str, time_us: float) -> Explained:
        outcome, step = self.outcome(name), self.plan.pipeline.nodes[name].what
        if isinstance(outcome, Skipped):
            at = f"{outcome.origin}: " if outcome.origin not in ("", name) else ""
            return Explained(name, step, "skipped", at + outcome.reason, time_us)
        if isinstance(outcome, Failed):
            if outcome.origin != name:
                return Explained(name, step, "failed", f"{outcome.origin} failed", time_us)
            return Explained(name, step, "failed", outcome.reason, time_us)
        state = "reused" if self.reused else "ran"
        return Explained(name, step, state, "", time_us, outcome)

    def __repr__(self) -> str:
        parts = []
        for name in self.plan.asked:
            outcome = self.outcome(name)
            parts.append(f"{name}={outcome!r}")
        return f"<Result frame {self.frame.index}: {', '.join(parts)}>"
