"""A linked form is held against its step: what differs is told in words."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from tactile_graph import Degenerate
from tactile_graph.compiled import compiled_later
from tactile_graph.steps import Linked
from tactile_graph.testing import BrokenPromises, check_step
from tactile_graph.wires import Points
from tactile_graph.wires.parts import PointsParts, points_of


def leftmost(points: Points) -> Points:
    """Return the point of the lowest x."""
    if not points.count or not np.isfinite(points.xy_cm).all():
        raise Degenerate("there is no point, or one that is no number")
    return Points(points.xy_cm[[points.xy_cm[:, 0].argmin()]])


def ends(xy: Any) -> bool:
    return bool(xy.shape[0] and np.isfinite(xy).all())


@compiled_later
def right_loops(points: PointsParts) -> tuple[bool, PointsParts]:
    """Return the same."""
    if not ends(points.xy_cm):
        return False, points
    return True, PointsParts(points.xy_cm[[points.xy_cm[:, 0].argmin()]])


@compiled_later
def careless_loops(points: PointsParts) -> tuple[bool, PointsParts]:
    """Return something whatever comes."""
    return True, PointsParts(points.xy_cm[:1])


@compiled_later
def wrong_loops(points: PointsParts) -> tuple[bool, PointsParts]:
    """Return the point of the highest x."""
    if not ends(points.xy_cm):
        return False, points
    return True, PointsParts(points.xy_cm[[points.xy_cm[:, 0].argmax()]])


@compiled_later
def bare_loops(points: PointsParts) -> tuple[bool, Any]:
    """Return an array in place of parts."""
    return False, points.xy_cm


@pytest.fixture
def linked_by(monkeypatch: pytest.MonkeyPatch) -> Callable[[Any], None]:
    """Return what gives the step a form in machine code."""

    def give(loops: Any) -> None:
        form = Linked(loops, PointsParts, points_of)
        monkeypatch.setattr(leftmost, "linked", lambda: form, raising=False)

    return give


def test_a_form_that_gives_the_same_keeps_its_promises(linked_by: Callable[[Any], None]) -> None:
    linked_by(right_loops)
    check_step(leftmost)


@pytest.mark.parametrize(
    ("loops", "told"),
    [
        (careless_loops, "its linked form gives <Points 0> where the step raises"),
        (wrong_loops, "its linked form gives <Points 1>, not <Points 1>"),
        (bare_loops, "its linked form gives ndarray, not PointsParts"),
    ],
)
def test_a_form_that_gives_something_else_is_told(
    linked_by: Callable[[Any], None], loops: Any, told: str
) -> None:
    linked_by(loops)
    with pytest.raises(BrokenPromises, match=told):
        check_step(leftmost)
