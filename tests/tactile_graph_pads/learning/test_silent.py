"""Dead elements and lines are those that stay silent where their neighbours do not."""

import numpy as np
import pytest

from tactile_graph_pads.learning.silent import between, silence

SHAPE = (12, 14)


def discs(n, rng, voids=0.15, radius=3.6):
    row, column = np.mgrid[: SHAPE[0], : SHAPE[1]]
    at = rng.uniform((2, 2), (SHAPE[0] - 3, SHAPE[1] - 3), (n, 2))
    far = np.hypot(row - at[:, :1, None], column - at[:, 1:, None])
    return (far < radius) & (rng.random((n, *SHAPE)) >= voids)


def test_what_is_dead_is_found_among_voids_and_nothing_else():
    touched = discs(150, np.random.default_rng(0))
    touched[:, 4, 5] = touched[:, 8, 9] = False
    touched[:, 6, :] = False
    found = silence(touched, touched, np.ones(SHAPE, bool))
    assert found.dead_rows == (6,)
    assert found.dead_columns == ()
    expected = np.zeros(SHAPE, bool)
    expected[4, 5] = expected[8, 9] = True
    expected[6] = True
    assert (found.dead == expected).all()
    assert found.voids == pytest.approx(0.15, abs=0.03)


def test_a_dead_column_is_found_though_it_parts_every_object():
    touched = discs(120, np.random.default_rng(1))
    touched[:, :, 7] = False
    found = silence(touched, touched, np.ones(SHAPE, bool))
    assert found.dead_columns == (7,)
    assert found.dead.sum() == SHAPE[0]


@pytest.mark.parametrize("seed", range(5))
def test_a_pad_with_many_voids_has_nobody_dead(seed):
    touched = discs(100, np.random.default_rng(seed), voids=0.4)
    found = silence(touched, touched, np.ones(SHAPE, bool))
    assert not found.dead.any()
    assert found.voids == pytest.approx(0.4, abs=0.05)


def test_few_frames_condemn_no_element():
    touched = discs(6, np.random.default_rng(2))
    touched[:, 4, 5] = False
    assert not silence(touched, touched, np.ones(SHAPE, bool)).dead.any()


def test_gaps_of_one_and_two_are_bridged_wider_ones_are_not():
    touched = np.zeros((1, 3, 12), bool)
    touched[0, 1, [0, 2, 5, 9]] = True
    assert np.flatnonzero(between(touched)[0, 1]).tolist() == [1, 3, 4]


def test_a_valley_between_two_objects_is_no_dead_element():
    """It reads little, but beside elements that read little too."""
    touched = np.ones((30, *SHAPE), bool)
    touched[:, 5, 5] = False
    pressed = touched.copy()
    pressed[:, 3:8, 3:8] = False
    assert not silence(touched, pressed, np.ones(SHAPE, bool)).dead.any()
    assert silence(touched, touched, np.ones(SHAPE, bool)).dead[5, 5]
