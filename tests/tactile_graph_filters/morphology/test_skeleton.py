import numpy as np
import pytest
from scipy import ndimage

from helpers_filters import mask_of, same_grid
from tactile_graph_filters.morphology.skeleton import skeleton


@pytest.mark.parametrize("method", ["zhang", "lee"])
def test_a_bar_becomes_a_line_one_cell_wide_within_it(method):
    bar = np.zeros((9, 20), bool)
    bar[3:6, 2:18] = True
    line = skeleton(mask_of(bar), method=method)
    assert same_grid(mask_of(bar), line)
    assert line.values.any()
    assert not (line.values & ~bar).any()
    assert line.values.sum(axis=0).max() == 1
    assert ndimage.label(line.values, np.ones((3, 3)))[1] == 1


def test_an_empty_mask_stays_empty():
    assert skeleton(mask_of(np.zeros((4, 4)))).count == 0
