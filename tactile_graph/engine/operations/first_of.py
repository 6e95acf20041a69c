"""The rule of ``first_of``: the first choice with a value is what it comes out with."""

from __future__ import annotations

from collections.abc import Sequence

from tactile_graph.engine.operations.step_operation import Block, Operation, State
from tactile_graph.engine.outcomes.outcome import NO_VALUE, Failed


def first_of(slot: int, choices: Sequence[tuple[int, Block]]) -> Operation:
    """Settle a slot by the first choice that has a value, else by a failure if one failed.

    Parameters
    ----------
    slot : int
    choices : sequence of (int, block)
        The slot of each, and what settles it with all that it needs.
    """

    def operation(state: State) -> None:
        failed = value = None
        for source, block in choices:
            for settle in block:
                settle(state)
            value = state[source]
            if value.__class__ not in NO_VALUE:
                state[slot] = value
                return
            if failed is None and value.__class__ is Failed:
                failed = value
        state[slot] = value if failed is None else failed

    return operation
