"""Images are taken as presses: above zero, of full scale, with what is looked at."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph_classifiers.reliefs.presses import MARGIN, Presses


def image() -> np.ndarray:
    counts = np.full((12, 20), 100.0)
    counts[5:7, 8:12] = 600.0
    return counts


def test_readings_are_above_zero_and_of_full_scale():
    presses = Presses.of([image()], 1000.0)
    assert presses.values[0, 5, 8] == pytest.approx(0.5)
    assert presses.values[0, 0, 0] == 0.0
    assert presses.totals()[0] == pytest.approx(4.0)


def test_the_box_is_the_footprint_and_a_margin_within_the_pad():
    presses = Presses.of([image()], 1000.0)
    assert presses.boxes[0].tolist() == [5 - MARGIN, 8 - MARGIN, 2 + 2 * MARGIN, 4 + 2 * MARGIN]
    np.testing.assert_allclose(presses.centres[0], [10.0, 6.0])
    assert not presses.cut()[0]


def test_a_press_at_the_edge_is_cut():
    counts = np.roll(image(), -5, axis=0)
    presses = Presses.of([counts], 1000.0)
    assert presses.cut()[0]
    assert presses.boxes[0][0] == 0


def test_a_broken_cell_says_nothing():
    counts = image()
    counts[5, 9] = np.nan
    presses = Presses.of([counts], 1000.0)
    assert presses.values[0, 5, 9] == 0.0
    assert not presses.good[0, 5, 9]
    assert presses.good.sum() == 239


@pytest.mark.parametrize(
    ("counts", "words"),
    [(np.full((4, 4), 7.0), "nothing reads more"), (np.full((4, 4), np.nan), "no cell")],
)
def test_where_nothing_touches_there_is_no_press(counts, words):
    with pytest.raises(ValueError, match=words):
        Presses.of([counts], 100.0)
