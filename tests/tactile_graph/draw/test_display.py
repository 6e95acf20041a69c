"""What drawing a value shows, whoever paints it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, ClassVar, NamedTuple

import numpy as np
import pytest

from tactile_graph import Circle, Frame, Image, Mask, Points, Rectangle
from tactile_graph.draw.display import (
    Area,
    Cells,
    Cross,
    Dots,
    Heat,
    Label,
    Note,
    Number,
    Outline,
    Rim,
    display_list,
    images_in,
    is_picture,
    truth_list,
)  # fmt: skip
from tactile_graph.engine.outcomes.outcome import Failed, Skipped
from tactile_graph.errors import PluginError
from tactile_graph.wires import TrueObject

ON = Mask(np.ones((1, 2), bool), (2.0, 1.0), (10.0, 5.0))
IMAGE = Image(np.ones((2, 2)))
POINTS = Points(np.array([[1.0, 2.0]]))


class Both(NamedTuple):
    mask: Mask
    score: float


class Placed(NamedTuple):
    x_cm: float
    y_cm: float
    mask: Mask
    kept: Skipped


class Seen:
    provides: ClassVar = {Points: "points"}
    points = POINTS


@pytest.mark.parametrize(
    ("value", "kinds"),
    [
        (Frame(IMAGE), [Heat]),
        (IMAGE, [Heat]),
        (ON, [Cells]),
        ([ON], [Rim]),
        (POINTS, [Dots]),
        (Circle(1, 2, 3), [Outline, Cross]),
        (Both(ON, 2.0), [Cells, Note]),
        (Placed(1.0, 2.0, ON, Skipped("a", "b")), [Cross, Rim]),
        (Seen(), [Dots]),
        ([Circle(1, 2, 3), Circle(4, 5, 6)], [Outline, Cross, Number] * 2),
        ([], [Note]),
        (2.5, [Note]),
    ],
    ids=lambda v: type(v).__name__,
)
def test_every_kind_of_value_is_listed(value: object, kinds: list[type]) -> None:
    assert [type(r) for r in display_list(value)] == kinds


def test_what_is_true_is_marked_so() -> None:
    true = truth_list([TrueObject(Circle(1, 2, 3)), TrueObject(Rectangle(4, 5, 6, 7, 0.0))])
    assert [getattr(r, "role", "") for r in true] == ["true"] * 4


def test_an_outline_is_in_cm_and_keeps_its_circle() -> None:
    circle = Circle(1.0, 2.0, 3.0)
    outline = display_list(circle)[0]
    assert isinstance(outline, Outline)
    assert outline.circle is circle
    np.testing.assert_allclose(np.hypot(*(outline.xy_cm - (1.0, 2.0)).T), 3.0)


class Stroke:
    outline_closed = False

    def outline_cm(self) -> np.ndarray:
        return np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 2.0]])


def test_a_line_is_closed_unless_its_record_says_it_is_open() -> None:
    (stroke,) = display_list(Stroke())
    box = display_list(Rectangle(4, 5, 6, 7, 0.0))[0]
    assert isinstance(stroke, Outline)
    assert isinstance(box, Outline)
    assert stroke.drawn_cm.tolist() == [[0.0, 0.0], [1.0, 0.0], [1.0, 2.0]]
    assert box.drawn_cm[0].tolist() == box.drawn_cm[-1].tolist()


def test_an_item_that_failed_keeps_its_number_and_says_why() -> None:
    failed = Failed("circles", ValueError("no"), item=(1,))
    shown = display_list([Circle(1, 2, 3), failed, Circle(4, 5, 6)])
    assert [r.text for r in shown if isinstance(r, Number)] == ["1", "3"]
    assert [r.value for r in shown if isinstance(r, Note)] == ["item 2 failed: ValueError: no"]


@pytest.mark.parametrize("value", [3, "a", True, [], [1, 2], (1.0,)])
def test_bare_values_are_no_picture(value: object) -> None:
    assert not is_picture(value)
    assert is_picture([value, IMAGE])


def test_the_images_of_a_value_are_those_shown_as_heat() -> None:
    assert images_in([IMAGE, ON, Frame(IMAGE)]) == [IMAGE, IMAGE]


class Kite:
    """Draws itself."""

    x_cm = y_cm = 1.0

    def drawing(self):
        yield Area(np.eye(3, 2))
        yield Label(1.0, 2.0, "kite")
        yield Outline(np.eye(2), closed=False)
        yield Note("tail", 3.0)


def test_a_value_that_draws_itself_is_drawn_so_in_its_role_and_without_a_number():
    kinds = [Area, Label, Outline, Note]
    assert [type(r) for r in display_list(Kite())] == kinds
    assert [type(r) for r in display_list([Kite(), Kite()])] == 2 * kinds
    assert {r.role for r in display_list(Kite(), "true")[:3]} == {"true"}


def test_of_what_is_true_only_lines_are_drawn():
    assert [type(r) for r in truth_list([TrueObject(Kite())])] == [Outline, Note]


def test_what_is_no_record_is_refused():
    class Wrong:
        def drawing(self):
            return [Heat(IMAGE)]

    with pytest.raises(PluginError, match=r"Wrong\.drawing\(\) must give records to draw, got"):
        display_list(Wrong())


class Smudged:
    def drawing(self) -> Iterator[Outline]:
        raise LookupError("no ink")
        yield


class Frayed:
    def outline_cm(self) -> None:
        raise LookupError("no edge")


class Lettered:
    def outline_cm(self) -> str:
        return "xx"


class Solid:
    def outline_cm(self) -> Any:
        return np.zeros((4, 3))


@pytest.mark.parametrize(
    ("value", "told"),
    [
        (Lettered(), r"Lettered\.outline_cm\(\) must give corners, .*, got 'xx'$"),
        (Solid(), r"Solid\.outline_cm\(\) must give .*, got an array of shape \(4, 3\)$"),
        (Smudged(), r"Smudged\.drawing\(\) breaks: LookupError: no ink \(.*display.py:\d+"),
        (
            Frayed(),
            r"Frayed\.outline_cm\(\) breaks: LookupError: no edge \(.*display.py:\d+",
        ),
    ],
)
def test_a_record_that_cannot_draw_itself_is_told_by_its_type(value: Any, told: str) -> None:
    with pytest.raises(PluginError, match=told):
        display_list(value)
