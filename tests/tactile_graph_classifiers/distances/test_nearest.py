from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import references_classifiers as references
from references_classifiers import two_smallest
from tactile_graph_classifiers.distances.nearest import nearest, nearest_normalised


def test_the_two_smallest_are_found_with_ties_to_the_first():
    assert two_smallest(np.array([3.0, 1.0, 2.0])) == (1, 2, 1.0, 2.0)
    assert two_smallest(np.array([2.0, 1.0, 1.0])) == (1, 2, 1.0, 1.0)
    assert two_smallest(np.array([5.0])) == (0, -1, 5.0, np.inf)
    assert two_smallest(np.array([np.inf, np.inf])) == (0, 1, np.inf, np.inf)


def test_every_distance_agrees_with_the_formula_written_out():
    rng = np.random.default_rng(0)
    means, reading = rng.normal(size=(6, 3)), rng.normal(size=3)
    roots = rng.normal(size=(6, 3, 3))
    precisions = roots @ roots.transpose(0, 2, 1)
    squares = [(reading - m) @ p @ (reading - m) for m, p in zip(means, precisions, strict=True)]
    order = np.argsort(squares)
    best, second, least, other = nearest.reference(reading, means, precisions)
    assert (best, second) == tuple(order[:2])
    assert (least, other) == pytest.approx(tuple(np.sort(squares)[:2]))


def test_normalised_distances_are_those_of_the_thesis():
    means = np.array([[100.0, 10.0], [300.0, 10.0], [100.0, 50.0]])
    ones = np.ones(means.shape)
    found = nearest_normalised.reference(np.array([140.0, 20.0]), means, ones, np.ones(2))
    # weight: 40, 160, 40 over 160; area: 10, 10, 30 over 30
    assert found == (0, 2, pytest.approx(1 / 16 + 1 / 9), pytest.approx(1 / 16 + 1.0))


def test_a_feature_in_which_all_objects_agree_has_no_share():
    means = np.array([[1.0, 5.0], [2.0, 5.0]])
    found = nearest_normalised.reference(np.array([1.0, 5.0]), means, np.ones((2, 2)), np.ones(2))
    assert found == (0, 1, 0.0, 1.0)


@pytest.mark.slow  # much is compiled
@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10**6), st.integers(1, 6), st.integers(1, 4))
def test_loops_find_what_the_references_do(seed, n_objects, n_features):
    pytest.importorskip("numba")
    rng = np.random.default_rng(seed)
    # whole numbers make ties likely
    means = rng.integers(0, 3, (n_objects, n_features)).astype(float)
    reading = rng.integers(0, 3, n_features).astype(float)
    roots = rng.integers(-1, 2, (n_objects, n_features, n_features)).astype(float)
    precisions = np.ascontiguousarray(roots @ roots.transpose(0, 2, 1)) + np.eye(n_features)
    scales = rng.integers(1, 3, means.shape).astype(float)
    weights = rng.integers(1, 3, n_features).astype(float)
    wanted = references.nearest(reading, means, precisions)
    for which in (nearest.loops, nearest.compiled):
        got = which(reading, means, precisions)
        assert got == (*wanted[:2], *map(pytest.approx, wanted[2:]))
        # Sums of whole numbers are exact, so ties are too.
    wanted = references.nearest_normalised(reading, means, scales, weights)
    for which in (nearest_normalised.loops, nearest_normalised.compiled):
        assert which(reading, means, scales, weights)[2:] == pytest.approx(wanted[2:])
