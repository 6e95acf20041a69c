"""The operations of what may be left undone: a decider is asked before each begins."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from tactile_graph.engine.deadlines.options import Decider, Option, Options
from tactile_graph.engine.operations.step_operation import Block, Operation, State
from tactile_graph.engine.outcomes.outcome import NO_VALUE


@dataclass(frozen=True)
class Deciding:
    """What of a program may be left undone, and who decides about it."""

    options: Options
    decider: Decider


def where_allowed(option: Option, body: Operation, decider: Decider) -> Operation:
    """Run the body of a node where that is allowed; otherwise it is skipped."""
    slot, skipped = option.slot, option.skipped
    allows, ended = decider.allows, decider.ended

    def operation(state: State) -> None:
        if allows(option, state):
            body(state)
            ended(option, state)
        else:
            state[slot] = skipped

    return operation


def ladder(
    slot: int, choices: Sequence[tuple[int, Block]], deciding: Deciding
) -> list[tuple[int, Block]]:
    """Return the choices of a ``first_of``, each left undone where it is not allowed."""
    options, rungs = deciding.options.choices, []
    for place, (source, block) in enumerate(choices):
        option = options.get((slot, place))
        if option is not None:
            block = (_rung(source, option, _whole(block), deciding.decider),)
        rungs.append((source, block))
    return rungs


def _whole(block: Block) -> Operation:
    def operation(state: State) -> None:
        for settle in block:
            settle(state)

    return operation


def _rung(source: int, option: Option, whole: Operation, decider: Decider) -> Operation:
    """Settle a choice with all that it needs, or leave all of it undone."""
    slot, skipped = option.slot, option.skipped
    allows, ended = decider.allows, decider.ended

    def operation(state: State) -> None:
        known = state[slot]
        if known is None and allows(option, state):
            whole(state)
            ended(option, state)
        elif known is None:
            state[slot] = state[source] = skipped
        elif known.__class__ in NO_VALUE:  # left undone by another ladder, for one
            state[source] = known
        else:
            whole(state)

    return operation
