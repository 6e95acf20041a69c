import numpy as np
import pytest
from scipy import ndimage

from helpers_filters import drawn, mask_of, random_mask, same_grid
from tactile_graph_filters.morphology.hit_or_miss import HitOrMiss

CORNER = [[0, 1, 0], [0, 1, 1], [0, 0, 0]]
AROUND = [[0, 0, 0], [1, 0, 0], [1, 1, 0]]


def test_without_miss_the_whole_window_must_match():
    mask = drawn("""
        .......
        .#..##.
        .......""")
    assert np.argwhere(HitOrMiss(hit=[[0, 0, 0], [0, 1, 0], [0, 0, 0]])(mask).values).tolist() == [
        [1, 1]
    ]


@pytest.mark.parametrize("seed", range(4))
def test_it_agrees_with_scipy(seed):
    mask = random_mask(seed, (20, 17), 0.5)
    expected = ndimage.binary_hit_or_miss(mask.values, CORNER, AROUND)
    found = HitOrMiss(hit=CORNER, miss=AROUND)(mask)
    # scipy takes cells outside for on when it looks for misses
    assert np.array_equal(found.values[1:-1, 1:-1], expected[1:-1, 1:-1])
    assert found.values.any()
    assert same_grid(mask, found)


def test_cells_outside_are_off_so_a_full_pad_has_corners():
    full = mask_of(np.ones((4, 4)))
    lower_left = HitOrMiss(hit=CORNER, miss=AROUND)(full)
    assert np.argwhere(lower_left.values).tolist() == [[3, 0]]
    assert HitOrMiss(hit=CORNER, miss=AROUND, border=True)(full).count == 0


def test_a_full_window_leaves_nothing_to_miss():
    assert HitOrMiss(hit="square3")(mask_of(np.ones((3, 3)))).count == 1


def test_a_cell_cannot_be_asked_to_be_on_and_off():
    with pytest.raises(ValueError, match="both hold the cell -1 down and 0 right of the centre"):
        HitOrMiss(hit="cross3", miss="cross3")
