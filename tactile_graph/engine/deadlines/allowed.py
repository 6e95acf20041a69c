"""The operations of what may be left undone: a decider is asked before each begins."""

from __future__ import annotations

from dataclasses import dataclass

from tactile_graph.engine.deadlines.options import Decider, Option, Options
from tactile_graph.engine.operations.step_operation import Block, Operation, State
from tactile_graph.engine.outcomes.outcome import NO_VALUE, Failed
from tactile_graph.engine.plan import Item


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


def ladder(item: Item, blocks: list[Block], deciding: Deciding) -> Operation:
    """Give the first choice that is allowed and comes out with a value; see ``first_of``."""
    slot, choices = item.slot, deciding.options.choices
    rungs = []
    for place, (port, block) in enumerate(zip(item.inputs, blocks, strict=True)):
        source, option = port.slots[0], choices.get((slot, place))
        whole = _whole(block)
        body = whole if option is None else _rung(source, option, whole, deciding.decider)
        rungs.append((source, body))

    def operation(state: State) -> None:
        failed = value = None
        for source, settle in rungs:
            settle(state)
            value = state[source]
            if value.__class__ not in NO_VALUE:
                state[slot] = value
                return
            if failed is None and value.__class__ is Failed:
                failed = value
        state[slot] = value if failed is None else failed

    return operation


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
