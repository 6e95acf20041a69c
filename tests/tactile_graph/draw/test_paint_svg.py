"""The pieces an SVG picture is made of, each against an answer known beforehand."""

from __future__ import annotations

import base64
import io
import math

import numpy as np
import pytest

from tactile_graph import Circle, Image, Mask, Points
from tactile_graph.draw.colours import MASK_OFF, MASK_ON
from tactile_graph.draw.display import Outline, display_list
from tactile_graph.draw.grid_png import change_uri, heat_uri, mask_uri
from tactile_graph.draw.paint_svg import SvgPicture, View
from tactile_graph.wires.cells_png import BROKEN, HEAT, LEVELS, TWO_WAYS, levels

# -- grids -------------------------------------------------------------------------------------


def pixels(uri: str) -> np.ndarray:
    from PIL import Image as Picture

    data = base64.b64decode(uri.removeprefix("data:image/png;base64,"))
    with Picture.open(io.BytesIO(data)) as picture:
        picture.load()
        return np.asarray(picture.convert("RGB"))


def test_a_mask_is_two_colours_cell_by_cell() -> None:
    on = np.zeros((3, 11), bool)
    on[1, 2:7] = on[2, 10] = True
    on_rgb, off_rgb = (list(bytes.fromhex(c[1:])) for c in (MASK_ON, MASK_OFF))
    expected = np.where(on[..., None], on_rgb, off_rgb)
    np.testing.assert_array_equal(pixels(mask_uri(Mask(on))), expected)


@pytest.mark.parametrize("n", [4, 10, 40])
def test_an_image_is_its_levels_broken_cells_apart(n: int) -> None:
    values = np.linspace(0.0, 1.0, n * n).reshape(n, n).copy()
    valid = np.ones((n, n), bool)
    valid[0, 1] = False
    shown = pixels(heat_uri(Image(values, valid=valid), 0.0, 1.0))
    assert tuple(shown[0, 1]) == BROKEN
    assert tuple(shown[0, 0]) == tuple(HEAT[0])
    assert tuple(shown[-1, -1]) == tuple(HEAT[LEVELS - 1])
    expected = np.rint(values * (LEVELS - 1)).astype(int)
    expected[0, 1] = LEVELS
    np.testing.assert_array_equal(shown, HEAT[expected])


def test_values_without_a_number_and_ranges_without_a_width_have_a_level_too() -> None:
    found = levels(np.array([[math.nan, 1.0, -math.inf]]), 1.0, 1.0)
    assert found.tolist() == [[LEVELS, 0, LEVELS]]


def test_a_difference_is_blue_where_less_and_orange_where_more() -> None:
    less, none, more = pixels(change_uri(np.array([[-2.0, 0.0, 2.0]])))[0].tolist()
    assert less == TWO_WAYS[0].tolist()
    assert more == TWO_WAYS[LEVELS - 1].tolist()
    assert less[2] > less[0]
    assert more[0] > more[2]
    assert min(none) > 230


# -- lines -------------------------------------------------------------------------------------


def test_points_lie_where_they_are_and_those_without_a_place_do_not() -> None:
    view = View.of(Image(np.zeros((4, 8)), (0.5, 0.5), (1.0, 2.0)))
    assert (view.width, view.height) == (200.0, 100.0)
    points = Points(np.array([[1.0, 2.0], [5.0, 4.0], [math.nan, 1.0]]))
    picture = SvgPicture(view, display_list(points))
    assert picture.lines[-1] == '<path d="M0.0 0.0h0M200.0 100.0h0" class="ink dots"></path>'


def test_a_circle_is_drawn_exactly_and_one_that_is_nowhere_not_at_all() -> None:
    view = View.of(Image(np.zeros((10, 10))))
    lines = SvgPicture(view, display_list(Circle(5.0, 2.5, 2.0))).lines
    assert lines[1] == '<circle cx="100" cy="50" r="40" class="ink"></circle>'
    assert lines[3] == '<path d="M94.0 50.0h12M100.0 44.0v12" class="ink"></path>'
    assert SvgPicture(view, display_list(Circle(math.nan, 2.5, 2.0))).lines == []


def test_an_open_line_does_not_return_to_its_start() -> None:
    corners = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 2.0]])
    for closed, last in ((True, "Z"), (False, "0")):
        lines = SvgPicture(
            View.of(Image(np.zeros((4, 4)))), [Outline(corners, closed=closed)]
        ).lines
        assert [line.split('"')[1][-1] for line in lines] == [last, last]


def test_notes_carry_the_names_of_their_fields() -> None:
    picture = SvgPicture(View.of(Image(np.zeros((2, 2)))), display_list([1, 2.34567, True]))
    assert picture.notes == ["1", "2.346", "yes"]
    assert picture.lines == picture.grids == []
