"""Contacts, the level from which there are any, and bad elements filled."""

import tracemalloc

import numpy as np
import pytest

from tactile_graph.wires import Image
from tactile_graph_filters.contacts.contacts import contacts
from tactile_graph_pads.learning.touching import (
    best_level,
    contacts_of,
    filled,
    least_level,
    paired,
    placements,
)


def bumps(*centres, shape=(20, 24), height=100.0):
    row, column = np.mgrid[: shape[0], : shape[1]]
    return sum(height * np.exp(-((column - x) ** 2 + (row - y) ** 2) / 4.0) for x, y in centres)


def test_contacts_are_those_of_the_step_that_will_find_them():
    values = bumps((5.3, 6.1), (16.7, 12.2)) + bumps((5.0, 17.0), height=40.0)
    found = contacts_of(values, 20.0)
    image = Image(values.copy(), (1.0, 1.0), (0.0, 0.0), "raw")
    theirs = contacts(image, image.mask(values >= 20.0)).contacts
    assert found.centres + 0.5 == pytest.approx(np.array([(c.x_cm, c.y_cm) for c in theirs]))
    assert found.cells.tolist() == [c.n_cells for c in theirs]
    assert found.peaks == pytest.approx([c.peak for c in theirs])


def test_pairs_are_each_others_nearest_within_the_gate():
    found, true = (
        np.array([(0.0, 0.0), (5.0, 0.0), (20.0, 0.0)]),
        np.array([(0.4, 0.0), (5.1, 0.0)]),
    )
    assert paired(found, true, 1.0) == [(0, 0), (1, 1)]
    assert paired(found[:1], np.zeros((0, 2)), 1.0) == []


def test_the_level_parts_what_a_low_one_runs_together():
    """Two bumps whose skirts meet: low levels count one, levels near the peak two."""
    frames = [bumps((8.0 - 0.1 * k, 8.0), (12.5, 8.0)) for k in range(10)]
    true = [np.array([(8.0 - 0.1 * k, 8.0), (12.5, 8.0)]) for k in range(10)]
    level, right = best_level(frames, true, 2.0)
    assert right == 1.0
    assert all(len(contacts_of(f, level).centres) == 2 for f in frames)
    assert len(contacts_of(frames[0], 2.0).centres) == 1


def test_without_a_better_one_the_lowest_level_stays():
    frames, true = [bumps((8.0, 8.0))] * 5, [np.array([(8.0, 8.0)])] * 5
    assert best_level(frames, true, 2.0) == (2.0, 1.0)
    hopeless = [np.array([(8.0, 8.0), (2.0, 2.0)])] * 5
    assert best_level(frames, hopeless, 2.0) == (2.0, 0.0)


def test_the_least_level_is_above_noise_flicker_and_rounding():
    some, quiet = np.array([[0.0, 50.0]]), np.full(200, 2.0)
    assert least_level(quiet, 1.0, some) == 12.0
    assert least_level(0.0 * quiet, 1.0, some) == 0.75
    flicker = np.where(np.arange(200) < 10, 0.5, 0.0)
    assert least_level(flicker, 1.0, some) == 1.5
    assert least_level(0.0 * quiet, 0.0, some) == pytest.approx(0.05)
    assert least_level(quiet[:0], 0.0, 0.0 * some) > 0.0


def test_bad_elements_read_as_those_around_them():
    row, column = np.mgrid[:8, :9]
    plane, good = 1.0 + 2.0 * row + 3.0 * column, np.ones((8, 9), bool)
    good[:, 4] = good[2, 7] = False
    there = filled(np.where(good, plane, -99.0)[None], good)[0]
    assert there[good] == pytest.approx(plane[good])
    assert there[1:-1, 4] == pytest.approx(plane[1:-1, 4])
    none = filled(plane[None], np.zeros_like(good))
    assert not none.any()


def test_frames_of_one_placement_count_once():
    at = [(5.0, 5.0)] * 4 + [(5.2, 5.0)] + [(15.0, 12.0)] * 3 + [(5.0, 5.0)]
    touched = np.array([bumps(c) > 20.0 for c in at])
    assert placements(touched).tolist() == [0, 5]
    assert placements(np.zeros((3, 4, 4), bool)).tolist() == []


def test_bad_elements_are_filled_without_a_second_copy_of_all_frames():
    values = np.random.default_rng(0).normal(size=(2000, 16, 16))
    good = np.ones((16, 16), bool)
    good[3:6, 4], good[0, 0] = False, False
    tracemalloc.start()
    try:
        found = filled(values, good)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak < 1.5 * values.nbytes
    around = [values[:, 0, 1], values[:, 1, 0], values[:, 1, 1]]
    np.testing.assert_allclose(found[:, 0, 0], np.mean(around, axis=0))
    np.testing.assert_array_equal(found[:, good], values[:, good])
