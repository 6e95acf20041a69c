"""Display lists as the page has them."""

from __future__ import annotations

import json
from base64 import b64decode

import numpy as np
import pytest

from tactile_graph import Circle, Image, Mask, Points, Polygon
from tactile_graph.draw.display import Area, Label, display_list
from tactile_graph_live.bench.shapes import MOST_EXACT, NO_READING, picture, readings, shapes


def levels(told: dict[str, object]) -> list[int]:
    return list(b64decode(str(told["values"])))


def test_an_image_goes_as_bytes_between_its_own_low_and_high() -> None:
    told = picture(Image(np.array([[0.0, 1.0], [2.0, 4.0]]), (1.3, 1.3), (0.5, 0.0), "volt"))
    assert levels(told) == [0, 63, 127, 254]
    assert (told["low"], told["high"], told["unit"]) == (0.0, 4.0, "V")
    assert (told["rows"], told["columns"], told["origin_cm"]) == (2, 2, [0.5, 0.0])


def test_cells_without_a_reading_are_told_from_those_that_read_the_most() -> None:
    valid = np.array([[True, False]])
    told = picture(Image(np.array([[1.0, 0.0]]), valid=valid))
    assert levels(told) == [254, NO_READING]
    assert levels(picture(Image(np.array([[np.nan, 1.0]])))) == [NO_READING, 254]


def test_readings_go_to_their_last_digit_whatever_the_range_of_colours() -> None:
    values = np.array([[0.0, -37.0, 0.0042], [1e9 + 1.0, np.nan, 5.0]])
    told = readings(Image(values, valid=np.array([[True] * 3, [True, True, False]])))
    assert told is not None
    expected = np.array([0.0, -37.0, 0.0042, 1e9 + 1.0, np.nan, np.nan])
    np.testing.assert_array_equal(np.frombuffer(b64decode(told), "<f8"), expected)


@pytest.mark.parametrize(
    ("values", "size"),
    [([0.0, -37.0, 0.0042], 4), ([0.0, 9999999.0, 4095.0], 4), ([0.0, 1e7, 1.0], 8),
     ([1e-40, 0.0, 1.0], 8), ([np.nan, 1.0, 2.0], 4), ([], 4)],
)  # fmt: skip
def test_readings_take_no_more_room_than_seven_digits_need(values: list[float], size: int) -> None:
    told = readings(Image(np.array([values])))
    assert told is not None
    found = np.frombuffer(b64decode(told), f"<f{size}")
    np.testing.assert_allclose(found, values, rtol=1e-7)


def test_a_large_pad_goes_by_its_colours_alone() -> None:
    assert readings(Image(np.zeros((1, MOST_EXACT)))) is not None
    assert readings(Image(np.zeros((1, MOST_EXACT + 1)))) is None


def test_what_lies_beyond_the_range_is_shown_as_its_end() -> None:
    assert levels(picture(Image(np.array([[-5.0, 0.5, 9.0]])), 0.0, 1.0)) == [0, 127, 254]


def test_an_image_of_nothing_but_one_value_has_a_picture() -> None:
    assert levels(picture(Image(np.zeros((1, 2))))) == [0, 0]


def test_a_circle_is_told_as_one_and_a_polygon_by_its_corners() -> None:
    circle, cross = shapes(display_list(Circle(1.0, 2.0, 3.0)), "fit")
    assert circle == {
        "role": "found", "node": "fit", "shape": "circle", "x": 1.0, "y": 2.0, "radius": 3.0
    }  # fmt: skip
    assert cross["shape"] == "cross"
    corners = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    assert shapes(display_list(Polygon(corners)))[0]["xy"] == corners.tolist()


def test_places_that_are_nowhere_are_left_out() -> None:
    nowhere = Points(np.array([[np.nan, 0.0], [1.0, 2.0]]))
    assert shapes(display_list(nowhere))[0]["xy"] == [[1.0, 2.0]]
    assert shapes(display_list(Circle(float("nan"), 0.0, 1.0))) == []


def test_every_kind_of_value_goes_as_json_without_nan() -> None:
    mask = Mask(np.array([[True, False]]))
    values = [mask, [mask, mask], (1.5, float("nan")), "word", Image(np.ones((2, 2)))]
    for value in values:
        json.dumps(shapes(display_list(value), "node"), allow_nan=False)


def test_an_area_is_a_polygon_that_is_filled() -> None:
    told = shapes([Area(np.zeros((3, 2))), Label(1.0, 2.0, "cup\x1b[2J")])
    assert told[0]["fill"] is True
    assert told[1]["text"] == "cup\\u001b[2J"
