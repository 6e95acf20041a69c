"""Pieces are cut where ground is empty, and convex ones are left whole."""

import numpy as np
import pytest

from tactile_graph_likelihood.several.beginnings.partings import spread
from tactile_graph_likelihood.several.beginnings.seeds import fullest_halves, seeds

ROWS, COLUMNS = np.mgrid[0:16, 0:24]


def disc(x, y, radius=3.2):
    return np.hypot(COLUMNS - x, ROWS - y) < radius


def test_three_discs_that_touch_are_cut_apart():
    discs = [disc(4, 4), disc(10, 4), disc(7, 10)]
    found = seeds([np.logical_or.reduce(discs)], 6, 4)
    assert len(found) == 3
    for one in discs:
        assert max((one & its).sum() / (one | its).sum() for its in found) > 0.85


@pytest.mark.parametrize(
    "mask",
    [disc(8, 8, 6.0), (abs(COLUMNS - 10) < 9) & (abs(ROWS - 8) < 3), disc(3, 3, 1.1)],
    ids=["disc", "rectangle", "a few elements"],
)
def test_a_convex_piece_is_left_whole(mask):
    found = seeds([mask], 6, 4)
    assert len(found) == 1
    assert (found[0] == mask).all()


@pytest.mark.slow
def test_a_carton_of_thousands_of_elements_is_left_whole_at_any_angle():
    rows, columns = np.mgrid[0:128, 0:128] - 63.5
    for angle in np.deg2rad([3.0, 10.0, 20.0, 35.0]):
        along = columns * np.cos(angle) + rows * np.sin(angle)
        across = rows * np.cos(angle) - columns * np.sin(angle)
        assert len(seeds([(abs(along) < 45) & (abs(across) < 22.5)], 6, 4)) == 1


def test_there_are_no_more_than_asked_for_unless_there_are_more_pieces():
    row = disc(4, 4) | disc(10, 4) | disc(16, 4)
    assert len(seeds([row], 2, 4)) == 2
    assert len(seeds([disc(4, 4), disc(16, 4)], 1, 4)) == 2


def test_the_emptiest_cut_comes_first():
    pair, far = disc(3, 4) | disc(9, 4), disc(3, 12, 2.5) | disc(19, 12, 2.5)
    assert len(found := seeds([pair, far], 3, 4)) == 3
    assert (found[0] == pair).all()


def test_halves_are_a_mask_and_what_it_leaves_of_the_piece():
    mask = disc(4, 4) | disc(11, 4)
    gain, half = fullest_halves(mask, 4)
    assert gain > 9.0
    assert {tuple(half[4, [4, 11]]), tuple((mask & ~half)[4, [4, 11]])} == {
        (True, False),
        (False, True),
    }
    assert fullest_halves(disc(3, 3, 1.1), 4)[0] == 0.0


def test_a_disc_covers_its_ellipse():
    mask = disc(10, 8, 6.0)
    x, y = COLUMNS[mask], ROWS[mask]
    sums = [mask.sum(), x.sum(), y.sum(), (x * x).sum(), (x * y).sum(), (y * y).sum(), 0.0]
    assert spread.call(np.array(sums, float)) == pytest.approx(mask.sum(), rel=0.03)
