import numpy as np
import pytest
from skimage.filters import threshold_otsu as skimage_otsu

from helpers_filters import image_of
from tactile_graph.errors import DataError, Degenerate
from tactile_graph.wires import Mask
from tactile_graph_filters.thresholds.threshold_otsu import threshold_otsu


@pytest.mark.parametrize("seed", range(10))
def test_it_parts_as_scikit_image_does(seed):
    rng = np.random.default_rng(seed)
    values = np.where(rng.random((16, 16)) < 0.3, rng.normal(180, 20, (16, 16)), 30).astype(int)
    values = np.clip(values + rng.integers(0, 20, (16, 16)), 0, 255)
    expected = values > skimage_otsu(values.astype(np.uint8))
    mask, level = threshold_otsu(image_of(values, "counts"))
    assert np.array_equal(mask.values, expected)
    assert level == values[expected].min()


@pytest.mark.parametrize("scale", [1e-300, 1.0, 1e300])
def test_two_groups_are_parted_at_any_scale(scale):
    values = np.array([[0.1, 0.2, 0.15], [0.9, 1.0, 0.95]]) * scale
    mask, level = threshold_otsu(image_of(values))
    assert mask.values.tolist() == [[False] * 3, [True] * 3]
    assert level == values[1, 0]


def test_readings_about_zero_are_parted_as_others_are():
    values = np.array([[-1.0, -0.9, -0.8, 0.9, 1.0]])
    assert threshold_otsu(image_of(values)).level == 0.9
    assert threshold_otsu(image_of(values + 5.0)).level == 5.9


def test_invalid_cells_have_no_say():
    values = [[0.0, 0.0, 1.0, 1.1, 900.0]]
    mask, _ = threshold_otsu(image_of(values, valid=[[True, True, True, True, False]]))
    assert mask.values.tolist() == [[False, False, True, True, False]]


def test_one_grey_level_is_degenerate():
    with pytest.raises(Degenerate, match="every valid cell holds 2: one grey level cannot"):
        threshold_otsu(image_of([[2.0, 2.0]]))


def test_no_valid_cell_is_degenerate():
    with pytest.raises(Degenerate, match="has no grey levels to choose from"):
        threshold_otsu(image_of([[0.0]], valid=[[False]]))


def test_infinity_is_refused():
    with pytest.raises(DataError, match="row 0, column 1: must be a number, got inf"):
        threshold_otsu(image_of([[0.0, np.inf]]))


def test_a_port_for_a_mask_takes_the_result():
    assert type(threshold_otsu(image_of([[0.0, 1.0]]))).provides == {Mask: "mask"}
