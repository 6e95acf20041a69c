import numpy as np
import pytest

import tactile_graph_filters.readings.inpaint as module
from helpers_filters import ORIGIN, PITCH, image_of, random_mask, same_grid
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Image
from tactile_graph_filters.readings.inpaint import inpaint


def holed(values, share=0.6, seed=0):
    valid = random_mask(seed, np.shape(values), share).values
    return image_of(np.where(valid, values, 0.0), "gram", valid)


def test_a_slope_is_filled_exactly():
    y, x = np.mgrid[0:9, 0:9]
    slope = 2.0 * x + 3.0 * y
    valid = np.ones((9, 9), bool)
    valid[3:6, 2:5] = False
    image = image_of(np.where(valid, slope, 0.0), "gram", valid)
    found = inpaint(image)
    assert found.values == pytest.approx(slope)
    assert found.valid is None
    assert found.quantity == "gram"
    assert same_grid(image, found)


@pytest.mark.parametrize("shape", [(8, 8), (40, 40)])
def test_each_filled_cell_is_the_weighted_mean_of_its_neighbours(shape):
    values = np.random.default_rng(1).random(shape)
    image = holed(values)
    found = inpaint(image).values
    weights = {(1, 0): (PITCH[0] / PITCH[1]) ** 2, (0, 1): 1.0}
    for i, j in np.argwhere(~image.valid):
        near = [
            (weight, found[i + s * di, j + s * dj])
            for (di, dj), weight in weights.items()
            for s in (-1, 1)
            if 0 <= i + s * di < shape[0] and 0 <= j + s * dj < shape[1]
        ]
        mean = sum(w * v for w, v in near) / sum(w for w, _ in near)
        assert found[i, j] == pytest.approx(mean)
    assert np.array_equal(found[image.valid], values[image.valid])
    assert 0.0 <= found.min() <= found.max() <= 1.0


def test_the_sparse_way_gives_the_same(monkeypatch):
    image = holed(np.random.default_rng(2).random((12, 12)))
    dense = inpaint(image).values
    monkeypatch.setattr(module, "DENSE_UP_TO", 0)
    assert inpaint(image).values == pytest.approx(dense)


def test_nearest_takes_the_value_of_the_nearest_valid_cell():
    image = image_of([[1.0, 0.0, 0.0, 0.0, 9.0]], valid=[[True, False, False, False, True]])
    assert inpaint(image, method="nearest").values.tolist() == [[1.0, 1.0, 1.0, 9.0, 9.0]]


def test_an_image_without_holes_is_returned_as_it_is():
    image = image_of([[1.0]])
    assert inpaint(image) is image
    all_good = inpaint(image_of([[1.0]], valid=[[True]]))
    assert all_good.valid is None
    assert all_good.origin_cm == ORIGIN


def test_nothing_valid_is_degenerate():
    with pytest.raises(Degenerate, match="no cell of the image is valid, so there is nothing"):
        inpaint(image_of([[0.0]], valid=[[False]]))


def test_the_nearest_cell_is_told_in_centimetres_not_in_cells():
    values = np.array([[7.0, 0.0], [5.0, 5.0]])
    valid = np.array([[True, False], [True, True]])
    for pitch, wanted in (((1.0, 3.0), 7.0), ((3.0, 1.0), 5.0)):
        image = Image(values, pitch_cm=pitch, valid=valid)
        assert inpaint(image, method="nearest").values[0, 1] == wanted
