import math

import numpy as np
import pytest
from pydantic import TypeAdapter, ValidationError
from scipy import ndimage

from helpers_filters import drawn, image_of, random_mask, same_grid
from helpers_modes import held
from tactile_graph.errors import DataError
from tactile_graph_filters.images.low_pass import LowPass, _checked, window_mean


@pytest.mark.parametrize("size", [1, 3, 5])
def test_the_mean_of_the_window_replaces_each_cell(size):
    values = np.random.default_rng(0).random((9, 12))
    image = image_of(values)
    found = LowPass(size=size)(image)
    half = size // 2
    inner = np.s_[half : 9 - half, half : 12 - half]
    assert found.values[inner] == pytest.approx(ndimage.uniform_filter(values, size)[inner])
    assert same_grid(image, found)
    assert found.quantity == "volt"


def test_weights_make_a_weighted_mean():
    weights = [[1.0, 2.0, 1.0], [2.0, 4.0, 2.0], [1.0, 2.0, 1.0]]
    values = np.random.default_rng(1).random((8, 8))
    expected = ndimage.convolve(values, np.array(weights) / 16)
    found = LowPass(weights=weights)(image_of(values)).values
    assert found[1:-1, 1:-1] == pytest.approx(expected[1:-1, 1:-1])


def test_weights_are_laid_on_the_image_as_they_are_written():
    found = LowPass(weights=[[0.0, 0.0, 1.0]])(image_of([[1.0, 2.0, 3.0]])).values
    assert found.tolist() == [[2.0, 3.0, 0.0]]


def test_an_even_image_stays_even_up_to_its_edges():
    assert LowPass()(image_of(np.full((4, 5), 7.0))).values == pytest.approx(np.full((4, 5), 7.0))


def test_invalid_cells_are_left_out_and_stay_invalid():
    image = image_of([[1.0, 0.0, 3.0]], valid=[[True, False, True]])
    found = LowPass()(image)
    assert found.values.tolist() == [[1.0, 0.0, 3.0]]
    assert found.valid.tolist() == [[True, False, True]]


def test_a_mask_gives_the_share_of_the_window_that_is_on():
    found = LowPass()(
        drawn("""
        .....
        .....
        ..#..
        .....
        .....
    """)
    )
    assert found.quantity == "level"
    assert found.values[1:4, 1:4] == pytest.approx(np.full((3, 3), 1 / 9))
    assert np.count_nonzero(found.values) == 9


def test_nan_is_refused():
    with pytest.raises(DataError, match="row 0, column 1: must be a number, got nan"):
        LowPass()(image_of([[1.0, math.nan]]))


def test_an_even_size_is_refused():
    with pytest.raises(ValueError, match=r"size must be odd, .* got 4"):
        LowPass(size=4)


@pytest.mark.parametrize(
    ("weights", "words"),
    [
        ([[1.0, 1.0]], "an odd number each way"),
        ([[1.0], [1.0, 1.0, 1.0], [1.0]], "equally long rows"),
        ([], "equally long rows"),
        ([[-1.0, 2.0, 1.0]], "must not be negative"),
        ([[0.0]], "some must be above 0"),
        ([[math.nan]], "must not be negative"),
    ],
)
def test_wrong_weights_are_refused(weights, words):
    with pytest.raises(ValueError, match=words):
        LowPass(weights=weights)


def test_weights_are_checked_when_the_pipeline_is_loaded():
    annotation = LowPass.__init__.__annotations__["weights"]
    assert "_checked" in str(annotation)
    assert _checked([[1.0]]) == [[1.0]]
    with pytest.raises(ValidationError):
        TypeAdapter(list[list[float]] | None).validate_python("3x3")


@pytest.mark.slow  # much is compiled
@pytest.mark.parametrize("shape", [(16, 16), (1, 1), (2, 9)])
@pytest.mark.parametrize("window", [(3, 3), (1, 5), (7, 3)])
def test_the_twins_agree(shape, window):
    pytest.importorskip("numba")
    rng = np.random.default_rng(2)
    values, weights = held(rng.random(shape)), rng.random(window) * (rng.random(window) < 0.8)
    usable = random_mask(2, shape).values.astype(float)
    outs = np.empty((2, *shape))
    window_mean.reference(values, usable, weights, outs[0])
    window_mean.compiled(values, usable, weights, outs[1])
    assert outs[0] == pytest.approx(outs[1], rel=1e-12, abs=1e-15)
