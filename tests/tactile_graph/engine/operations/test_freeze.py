"""What a step returns is frozen as far as it goes, whatever it is made of."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from tactile_graph.engine.operations.freeze import freeze

if TYPE_CHECKING:
    from decimal import Decimal


@dataclass
class Record:
    array: Any
    inner: Any = None
    never_set: int = field(init=False)


@dataclass(frozen=True)
class Hidden:
    """A record whose annotation only a type checker can read."""

    n: Decimal


def array() -> np.ndarray[Any, Any]:
    return np.zeros(3)


@pytest.mark.parametrize(
    "wrap",
    [
        lambda a: a,
        lambda a: [a],
        lambda a: (1, [a]),
        lambda a: {"x": a},
        lambda a: Record(a),
        lambda a: [Record(1, (a,))],
    ],
    ids=range(6),
)
def test_arrays_become_read_only_wherever_they_are(wrap: Any) -> None:
    a = array()
    freeze(wrap(a))
    with pytest.raises(ValueError, match="read-only"):
        a[0] = 1.0


def test_nothing_is_copied_and_lists_become_tuples() -> None:
    a = array()
    frozen = freeze([a, (1, 2)])
    assert isinstance(frozen, tuple)
    assert frozen[0] is a
    pair = (1, 2)
    assert freeze(pair) is pair


@pytest.mark.parametrize("value", [None, 1, "x", Hidden(3), object(), range(3)])  # type: ignore[arg-type]
def test_what_holds_no_array_is_left_as_it_is(value: Any) -> None:
    assert freeze(value) is value
