import numpy as np
import pytest

import references_filters as references
from helpers_filters import ORIGIN, image_of, random_mask
from tactile_graph_filters.images.subdivide_image import subdivide_image
from tactile_graph_filters.morphology.subdivide import expand, subdivide


@pytest.mark.parametrize("factor", [1, 2, 3, 10])
def test_each_cell_becomes_factor_by_factor_cells_in_the_same_place(factor):
    mask = random_mask(0, (5, 9))
    fine = subdivide(mask, factor=factor)
    assert np.array_equal(fine.values, np.kron(mask.values, np.ones((factor, factor), bool)))
    assert fine.origin_cm == ORIGIN
    assert fine.pitch_cm == pytest.approx((1.3 / factor, 0.7 / factor))
    assert fine.area_cm2 == pytest.approx(mask.area_cm2)
    assert fine.extent_cm == pytest.approx(mask.extent_cm)


def test_an_image_keeps_values_quantity_and_invalid_cells():
    valid = [[True, False], [True, True]]
    image = image_of([[1.0, 0.0], [3.0, 4.0]], "gram", valid)
    fine = subdivide_image(image, factor=3)
    assert np.array_equal(fine.values, np.kron(image.values, np.ones((3, 3))))
    assert np.array_equal(fine.valid, np.kron(valid, np.ones((3, 3), bool)))
    assert fine.quantity == "gram"
    assert fine.extent_cm == pytest.approx(image.extent_cm)


def test_an_image_without_invalid_cells_has_none_afterwards():
    image = image_of([[1.0, 2.0]])
    assert subdivide_image(image, factor=2).valid is None
    assert subdivide_image(image, factor=1) is image


@pytest.mark.slow  # much is compiled
@pytest.mark.parametrize("factor", [1, 2, 5])
def test_it_cuts_as_the_reference_does(factor):
    pytest.importorskip("numba")
    values = random_mask(1, (4, 7)).values
    outs = np.empty((3, 4 * factor, 7 * factor), bool)
    for which, out in zip((references.expand, expand.loops, expand.compiled), outs, strict=True):
        which(values, factor, out)
    assert np.array_equal(outs[0], outs[1])
    assert np.array_equal(outs[0], outs[2])
