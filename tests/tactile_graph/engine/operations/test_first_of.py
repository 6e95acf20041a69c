"""What a choice comes out with: its first value, else its first failure, else its last skip."""

from __future__ import annotations

from itertools import product
from typing import Any

import pytest

from tactile_graph.engine.operations.first_of import first_of
from tactile_graph.engine.outcomes.outcome import Failed, Skipped

COMES_OUT = {
    "value": lambda origin: f"value of {origin}",
    "skip": lambda origin: Skipped(origin, "its guard does not hold"),
    "failure": lambda origin: Failed(origin, ValueError("too small")),
}
CHOICES = [kinds for n in (1, 2, 3) for kinds in product(COMES_OUT, repeat=n)]


def settled(kinds: tuple[str, ...]) -> tuple[Any, list[Any], int]:
    """Return what a choice comes out with, what its choices do, and how many were looked at."""
    outcomes = [COMES_OUT[kind](f"n{i}") for i, kind in enumerate(kinds)]
    state: list[Any] = [None] * (len(kinds) + 1)
    asked: list[int] = []

    def settling(i: int) -> Any:
        def settle(state: list[Any]) -> None:
            asked.append(i)
            state[i + 1] = outcomes[i]

        return settle

    first_of(0, [(i + 1, [settling(i)]) for i in range(len(kinds))])(state)
    assert asked == list(range(len(asked)))  # one after the other
    return state[0], outcomes, len(asked)


@pytest.mark.parametrize("kinds", CHOICES, ids="-".join)
def test_first_value_else_first_failure_else_last_skip(kinds: tuple[str, ...]) -> None:
    found, outcomes, n_asked = settled(kinds)
    if "value" in kinds:
        first = kinds.index("value")
        assert found is outcomes[first]
        assert n_asked == first + 1  # the rest is not computed
    elif "failure" in kinds:
        assert found is outcomes[kinds.index("failure")]
    else:
        assert found is outcomes[-1]
