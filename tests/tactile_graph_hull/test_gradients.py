"""Partial differences, digital gradient, Sobel."""

import numpy as np
import pytest
from scipy import ndimage

from tactile_graph.wires import Image, Mask
from tactile_graph_hull.digital_gradient import digital_gradient
from tactile_graph_hull.partial_differences import partial_differences
from tactile_graph_hull.sobel import sobel


@pytest.fixture
def values():
    return np.random.default_rng(2).normal(size=(9, 12))


def test_differences_are_those_of_equations_3_1_and_3_2(values):
    dx, dy = partial_differences(Image(values.copy(), quantity="volt"))
    for r in range(9):
        for c in range(12):
            left = values[r, c] - values[r, c - 1] if c > 0 else 0.0
            above = values[r, c] - values[r - 1, c] if r > 0 else 0.0
            assert (dx.values[r, c], dy.values[r, c]) == (left, above)
    assert dx.quantity == dy.quantity == "volt"


def test_differences_to_or_from_an_invalid_cell_are_0(values):
    valid = np.ones(values.shape, dtype=bool)
    valid[4, 5] = False
    values[4, 5] = 0.0
    dx, dy = partial_differences(Image(values.copy(), valid=valid))
    assert dx.values[4, 5] == dx.values[4, 6] == dy.values[4, 5] == dy.values[5, 5] == 0.0
    assert dx.values[5, 5] == values[5, 5] - values[5, 4]
    assert dx.valid is valid


def test_differences_of_a_mask_are_minus_one_zero_and_one():
    mask = Mask(np.array([[False, True, True, False]] * 2), (0.5, 0.5), (1.0, 2.0))
    dx, dy = partial_differences(mask)
    assert dx.values.tolist() == [[0, 1, 0, -1]] * 2
    assert not dy.values.any()
    assert (dx.quantity, dx.pitch_cm, dx.origin_cm) == ("binary", (0.5, 0.5), (1.0, 2.0))


@pytest.mark.parametrize(
    ("norm", "size"),
    [
        ("euclid", np.hypot),
        ("sum", lambda a, b: abs(a) + abs(b)),
        ("max", lambda a, b: np.maximum(abs(a), abs(b))),
    ],
)
def test_digital_gradient_is_the_chosen_norm_of_the_differences(values, norm, size):
    image = Image(values, (1.3, 1.3), quantity="volt")
    dx, dy = partial_differences(image)
    gradient = digital_gradient(image, norm=norm)
    assert np.array_equal(gradient.values, size(dx.values, dy.values))
    assert (gradient.quantity, gradient.pitch_cm) == ("volt", (1.3, 1.3))


def test_sobel_is_scipys_inside_and_0_at_the_border(values):
    expected = np.hypot(ndimage.sobel(values, 0), ndimage.sobel(values, 1)) / 8.0
    got = sobel(Image(values.copy())).values
    assert got[1:-1, 1:-1] == pytest.approx(expected[1:-1, 1:-1], abs=1e-14)
    got = got.copy()
    got[1:-1, 1:-1] = 0.0
    assert not got.any()


def test_sobel_of_a_ramp_is_its_slope_a_cell():
    ramp = np.add.outer(3.0 * np.arange(6), 4.0 * np.arange(7))
    assert sobel(Image(ramp)).values[1:-1, 1:-1] == pytest.approx(5.0)


def test_sobel_sees_nothing_of_windows_with_an_invalid_cell(values):
    valid = np.ones(values.shape, dtype=bool)
    valid[4, 5] = False
    got = sobel(Image(values, valid=valid)).values
    assert not got[3:6, 4:7].any()
    assert got[3, 7] > 0.0


@pytest.mark.parametrize("shape", [(1, 1), (2, 5), (5, 2)])
def test_images_too_small_for_the_window_have_no_gradient(shape):
    assert not sobel(Image(np.ones(shape))).values.any()


@pytest.mark.parametrize("step", [sobel, digital_gradient])
def test_edges_of_a_mask_are_found_on_all_sides(step):
    values = np.zeros((12, 12), dtype=bool)
    values[4:9, 3:8] = True
    edges = step(Mask(values)).values > 0.1
    assert edges[6, 3]
    assert edges[4, 5]
    assert edges[6, 8]
    assert edges[9, 5]
    assert not edges[6, 5]
    assert not edges[1, 1]
