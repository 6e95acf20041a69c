"""What a plan would have come to alone, from a run that settled more than it asks for.

No rule of skipping stands here: the plan is made into the same program that runs frames, only that
its calls hand out recorded outcomes. What it settles is what the plan alone would have run.
"""

from __future__ import annotations

from collections import ChainMap
from collections.abc import Callable, Mapping
from dataclasses import replace
from operator import itemgetter
from typing import Any, TypeVar

from tactile_graph.engine.operations.fields import field_getter
from tactile_graph.engine.outcomes.outcome import NO_VALUE, Failed, Skipped, gaps
from tactile_graph.engine.outcomes.outcomes import (
    INNER,
    ITEM_FAILURES,
    REUSED,
    Outcomes,
    blank_state,
)
from tactile_graph.engine.plan import Plan
from tactile_graph.engine.program import Reading, make_program
from tactile_graph.pipeline.graph import FRAME, Node
from tactile_graph.pipeline.wiring import Ref

Read = Callable[[list[Any]], tuple[Any, ...]]
AnyOutcomes = TypeVar("AnyOutcomes", bound=Outcomes)


class Replay:
    """Call it with a recorded result, get the one that the plan alone would have given.

    Outcomes are the recorded ones, skips and failures in the plan's own names and the words of its
    own guards; nodes the plan alone would not have settled are not asked for. A node it settles
    has the time recorded for it.

    Parameters
    ----------
    plan : Plan
    recorded_as : mapping of str to str
        Each node of the plan -> the recorded node that does the same to the same. Every run to be
        replayed must settle at least what the plan alone would.
    """

    def __init__(self, plan: Plan, recorded_as: Mapping[str, str]) -> None:
        self.plan = plan
        self._recorded_as = {FRAME: FRAME, **recorded_as}
        self._own_names = {known: name for name, known in self._recorded_as.items()}
        self._recorded: tuple[Any, ...] = ()
        self._reads: list[tuple[Plan, Read]] = []
        self._blank = blank_state(plan.n_slots)
        # What depends on no frame is settled anew in each: it counts only where it is needed.
        forgotten = self._blank.copy()
        reading = Reading(self._field_of)
        self._operations = make_program(plan, self._call_of, forgotten, reading)

    def __call__(self, result: AnyOutcomes) -> AnyOutcomes:
        """Return what the plan came to in the frame of a recorded result."""
        recorded = self._recorded = self._reader(result.plan)(result.whole_state)
        n, state = self.plan.n_slots, self._blank.copy()
        state[self.plan.image] = recorded[self.plan.image]
        state[0] = recorded[0]
        for settle in self._operations:
            settle(state)
        state[n : 2 * n] = [
            0 if outcome is None else time
            for outcome, time in zip(state, recorded[n:], strict=False)
        ]
        state[REUSED] = result.reused
        failures, inner = result._state[ITEM_FAILURES], result.inner
        if failures or inner:
            settled = [i.name for i in self.plan.nodes if state[i.slot] is not None]
            rows = [(name, self._recorded_as[name]) for name in settled]
            state[ITEM_FAILURES] = [
                f.at(name) for name, known in rows for f in failures if f.origin == known
            ]
            state[INNER] = {name: inner[known] for name, known in rows if known in inner}
        return type(result)(self.plan, state)

    def _reader(self, recorded: Plan) -> Read:
        """Return what takes the plan's outcomes and times out of a state of the recorded plan."""
        for plan, read in self._reads:
            if plan is recorded:
                return read
        slots = [recorded.refs[self._recorded_ref(ref)] for ref in self.plan.refs]
        read = itemgetter(*slots, *(recorded.n_slots + slot for slot in slots))
        self._reads.append((recorded, read))
        return read

    def _recorded_ref(self, ref: Ref) -> Ref:
        return replace(ref, node=self._recorded_as[ref.node])

    # -- what stands in for calls -------------------------------------------------------------

    def _call_of(self, node: Node) -> Callable[..., Any]:
        """Return what hands out a node's recorded outcome, whatever it is called with."""
        slot, name = self.plan.refs[Ref(node.name)], node.name
        known = self._recorded_as[name]
        near = [*(ref.node for ref in node.wires()), name]  # of equal nodes, the nearest counts
        own_names = ChainMap({self._recorded_as[n]: n for n in near}, self._own_names)

        def call(*_: Any, **__: Any) -> Any:
            outcome = self._recorded[slot]
            if outcome is None:
                raise LookupError(f"nothing was recorded of {known!r}")
            return _renamed(outcome, own_names)

        return call

    def _field_of(self, ref: Ref) -> Callable[[Any], Any]:
        """Return what hands out the recorded field of a node; what it lacks is told anew."""
        slot, get = self.plan.refs[ref], field_getter(ref)

        def field(value: Any) -> Any:
            outcome = self._recorded[slot]
            return get(value) if outcome.__class__ in NO_VALUE or gaps(outcome) else outcome

        return field


def _renamed(outcome: Any, own_names: Mapping[str, str]) -> Any:
    """Return an outcome that began at a recorded node, or in it, as of the plan's own.

    So are those of a list's items, and of the outputs of a pipeline run over a list.
    """
    if isinstance(outcome, Skipped | Failed):
        origin = _renamed_origin(outcome.origin, own_names)
        return outcome if origin == outcome.origin else outcome.at(origin)
    if gaps(outcome) or not _is_whole(outcome):
        renamed = [_renamed(value, own_names) for value in outcome]
        return outcome._make(renamed) if hasattr(outcome, "_make") else tuple(renamed)
    return outcome


def _renamed_origin(origin: str, own_names: Mapping[str, str]) -> str:
    """Return a node's name, or that of what is in it or a field of it, in the plan's own."""
    known = origin
    while known:
        if known in own_names:
            return own_names[known] + origin[len(known) :]
        known = known[: max(known.rfind("/"), known.rfind("."), 0)]
    return origin


def _is_whole(value: Any) -> bool:
    """Return whether all outputs of a pipeline that was run over a list have a value."""
    return not hasattr(value, "_make") or all(v.__class__ not in NO_VALUE for v in value)
