import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

import references_filters as references
from helpers_filters import image_of, same_grid
from tactile_graph.errors import DataError, Degenerate
from tactile_graph.wires import Image
from tactile_graph_filters.thresholds.threshold import Threshold, any_at_least, at_least

VALUES = [[0.0, 0.01, 0.02], [-1.0, 5.0, 0.009]]


def test_cells_at_or_above_the_level_are_on():
    image = image_of(VALUES)
    mask = Threshold(level_v=0.01)(image)
    assert mask.values.tolist() == [[False, True, True], [False, True, False]]
    assert same_grid(image, mask)
    assert not mask.values.flags.writeable


def test_above_asks_to_exceed_the_level():
    mask = Threshold(level_v=0.01, above=True)(image_of(VALUES))
    assert mask.values.tolist() == [[False, False, True], [False, True, False]]
    assert Threshold(level=0.0, above=True)(image_of([[0.0, 5e-324]])).values.tolist() == [
        [False, True]
    ]


def test_level_is_in_the_images_own_unit():
    counts = image_of([[24, 25, 26]], "counts")
    assert Threshold(level=25)(counts).values.tolist() == [[False, True, True]]


def test_images_of_whole_numbers_are_taken():
    image = Image(np.array([[1, 2], [3, 4]], np.int16), quantity="counts")
    assert Threshold(level=2.5)(image).values.tolist() == [[False, False], [True, True]]


def test_invalid_cells_are_never_on():
    image = image_of([[0.0, 3.0, 3.0]], valid=[[False, False, True]])
    assert Threshold(level=-1.0)(image).values.tolist() == [[False, False, True]]


def test_an_image_without_a_valid_cell_is_degenerate():
    image = image_of([[0.0, 0.0]], valid=[[False, False]])
    with pytest.raises(Degenerate, match="no cell of the image is valid, so it has no footprint"):
        Threshold(level=1.0)(image)


def test_nan_in_a_valid_cell_is_never_silently_off():
    image = image_of([[1.0, 2.0], [math.nan, math.nan]])
    with pytest.raises(DataError, match=r"row 1, column 0: must be a number, got nan \(and 1 more"):
        Threshold(level=1.0)(image)


def test_nan_in_an_invalid_cell_does_no_harm():
    image = image_of([[math.nan, 2.0]], valid=[[False, True]])
    assert Threshold(level=1.0)(image).values.tolist() == [[False, True]]


def test_infinity_is_above_every_level():
    assert Threshold(level=1.0)(image_of([[math.inf, -math.inf]])).values.tolist() == [
        [True, False]
    ]


def test_a_pad_that_stays_empty_gives_the_same_mask_until_something_lies_there_again():
    step = Threshold(level=1.0)
    empty = [step(image_of(np.full((3, 4), 0.1 * i))) for i in range(3)]
    assert empty[0] is empty[1] is empty[2]
    assert empty[0].count == 0
    assert step(image_of(np.eye(3, 4))).values.tolist() == np.eye(3, 4, dtype=bool).tolist()
    assert step(image_of(np.zeros((3, 4)))).count == 0


def test_an_empty_mask_lies_on_the_grid_of_its_own_image():
    step = Threshold(level=1.0)
    for image in (
        Image(np.zeros((3, 4))),
        Image(np.zeros((4, 3))),
        Image(np.zeros((4, 3)), (0.5, 1.0)),
        Image(np.zeros((4, 3)), (0.5, 1.0), (2.0, 0.0)),
    ):
        assert same_grid(step(image), image)


def test_what_comes_after_an_empty_pad_is_looked_at_in_full():
    step = Threshold(level=1.0)
    step(Image(np.zeros((2, 2))))
    valid = np.array([[True, True], [True, False]])
    assert step(Image(np.array([[0.0, 2.0], [0.0, 2.0]]), valid=valid)).count == 1
    step(Image(np.zeros((2, 2))))
    with pytest.raises(DataError, match="row 0, column 1: must be a number, got nan"):
        step(Image(np.array([[0.0, math.nan], [0.0, 0.0]])))
    step(Image(np.zeros((2, 2))))
    with pytest.raises(Degenerate):
        step(Image(np.zeros((2, 2)), valid=np.zeros((2, 2), bool)))


@pytest.mark.parametrize("number", [0.5, 1.0, math.inf, math.nan, -math.inf])
def test_any_at_least_plain_and_compiled(number):
    values = np.array([[0.0, 0.5], [number, 0.0]])
    expected = not number < 1.0
    assert any_at_least.loops(values, 1.0) == any_at_least.compiled(values, 1.0) == expected


@pytest.mark.parametrize(
    ("given_levels", "got"), [({}, "neither"), ({"level_v": 1.0, "level": 1.0}, "both")]
)
def test_exactly_one_level_must_be_given(given_levels, got):
    with pytest.raises(ValueError, match=f"exactly one of level_v and level .* got {got}"):
        Threshold(**given_levels)


def test_the_level_must_be_finite():
    with pytest.raises(ValueError, match="the level must be a finite number, got nan"):
        Threshold(level=math.nan)


@given(arrays(np.float64, (5, 7)), st.floats(allow_nan=False))
def test_it_compares_as_the_reference_does(values, level):
    pytest.importorskip("numba")
    outs = np.empty((3, 5, 7), bool)
    kernels = (references.at_least, at_least.loops, at_least.compiled)
    counts = {which(values, level, out) for which, out in zip(kernels, outs, strict=True)}
    assert counts == {-1 if np.isnan(values).any() else int(np.sum(values >= level))}
    assert np.array_equal(outs[0], outs[1])
    assert np.array_equal(outs[0], outs[2])
