"""A digest changes with the code of any function beneath and with the constants it reads."""

from __future__ import annotations

from collections.abc import Callable
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
import pytest

from tactile_graph.compiled import compiled_as_is
from tactile_graph.compiled.reach import Reach

SOURCE = """
def inner(x):
    return x * SCALE

def outer(x):
    total = 0.0
    for i in range(3):
        total += inner(x + i)
    return total

def other(x):
    return x
"""


class Sizes(NamedTuple):
    first: int


def digest(source: str = SOURCE, kernel: Callable[..., Any] = compiled_as_is, **names: Any) -> str:
    """Return the digest of ``outer`` in a source, its functions made kernels."""
    space: dict[str, Any] = {"SCALE": 2.0, **names}
    exec(source, space)
    loops = space["outer"]
    space["inner"] = kernel(space["inner"])
    return Reach(loops).digest


def test_equal_code_has_an_equal_digest() -> None:
    assert digest() == digest()


@pytest.mark.parametrize(
    ("old", "new"),
    [("x * SCALE", "x / SCALE"), ("range(3)", "range(4)"), ("x * SCALE", "x * SCALE + 1.0")],
)
def test_a_change_of_the_code_beneath_changes_it(old: str, new: str) -> None:
    assert digest(SOURCE.replace(old, new)) != digest()


@pytest.mark.parametrize(
    ("one", "two"),
    [
        (2.0, 3.0),
        (1, 1.0),
        (np.zeros(3), np.ones(3)),
        ((1, 2), (1, 3)),
        (Sizes, NamedTuple("Sizes", [("first", float)])),
    ],
)
def test_a_change_of_a_constant_changes_it(one: Any, two: Any) -> None:
    assert digest(SCALE=one) != digest(SCALE=two)


def test_a_renamed_file_changes_it() -> None:
    assert digest(__name__="old") != digest(__name__="new")


def test_constants_of_modules_count() -> None:
    source = SOURCE.replace("SCALE", "sizes.scale")
    found = []
    for scale in (1.0, 2.0):
        sizes = ModuleType("sizes")
        sizes.scale = scale  # type: ignore[attr-defined]
        found.append(digest(source, sizes=sizes))
    assert found[0] != found[1]


def test_comments_and_other_functions_do_not_count() -> None:
    moved = SOURCE.replace("def inner", "# a remark\n\ndef inner").replace(
        "return x\n", "return 0\n"
    )
    assert digest(moved) == digest()


def test_kernels_beneath_are_counted_once() -> None:
    from helpers_kernels import spread

    assert len(Reach(spread.loops).sizes) == 3
