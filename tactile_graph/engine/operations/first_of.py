"""The rule of ``first_of``: the first choice with a value is what it comes out with."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tactile_graph.engine.operations.step_operation import Block, Operation, State
from tactile_graph.engine.outcomes.outcome import NO_VALUE, Failed, Skipped


def first_of(slot: int, choices: Sequence[tuple[int, Block]]) -> Operation:
    """Settle a slot by the first choice that has a value, else by a failure if one failed.

    Parameters
    ----------
    slot : int
    choices : sequence of (int, block)
        The slot of each, and what settles it with all that it needs.
    """

    sources = [source for source, _ in choices[:-1]]

    def operation(state: State) -> None:
        failed: Any = None
        value: Any = None
        for source, block in choices:
            for settle in block:
                settle(state)
            value = state[source]
            if value.__class__ not in NO_VALUE:
                state[slot] = value
                return
            if failed is None and value.__class__ is Failed:
                failed = value
        state[slot] = _last(value, state, sources) if failed is None else failed

    return operation


def _last(value: Skipped, state: State, sources: Sequence[int]) -> Skipped:
    """Return the last choice's skip; unforeseen where that of any choice is."""
    if value.unforeseen or value.item:  # that of an item is known again by being the very same
        return value
    for source in sources:
        if state[source].unforeseen:
            return value.at(value.origin, unforeseen=True)
    return value
