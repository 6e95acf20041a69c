from __future__ import annotations

from itertools import permutations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tactile_graph_classifiers.database.statistics import Statistics


def same(a: Statistics, b: Statistics, rel: float = 1e-9) -> None:
    assert a.n == b.n
    np.testing.assert_allclose(a.mean, b.mean, rtol=rel, atol=1e-9)
    np.testing.assert_allclose(a.covariance, b.covariance, rtol=rel, atol=1e-7)


def test_they_are_mean_and_unbiased_covariance():
    rows = np.random.default_rng(0).normal(size=(9, 3))
    found = Statistics.of(rows)
    np.testing.assert_allclose(found.mean, rows.mean(axis=0))
    np.testing.assert_allclose(found.covariance, np.cov(rows.T))


@settings(max_examples=50, deadline=None)
@given(st.integers(0, 10**6), st.lists(st.integers(0, 6), min_size=1, max_size=5))
def test_readings_joined_in_parts_give_what_all_give_at_once(seed, sizes):
    rng = np.random.default_rng(seed)
    parts = [rng.normal(2000.0, 10.0, (n, 2)) for n in sizes]
    found = Statistics.none(2)
    for part in parts:
        found = found.joined(Statistics.of(part))
    same(found, Statistics.of(np.concatenate(parts)))


def test_every_order_of_readings_gives_the_same():
    rows = np.array([[1.0, 5.0], [2.0, -1.0], [4.0, 0.5], [-3.0, 2.0]])
    wanted = Statistics.of(rows)
    for order in permutations(range(4)):
        found = Statistics.none(2)
        for i in order:
            found = found.joined(Statistics.of(rows[i : i + 1]))
        same(found, wanted)


def test_nothing_cancels_where_the_mean_is_large_against_the_spread():
    rows = 1e9 + np.array([[0.0], [1.0], [2.0]])
    found = Statistics.none(1)
    for row in rows:
        found = found.joined(Statistics.of(row[None]))
    assert found.covariance[0, 0] == pytest.approx(1.0)


def test_fewer_than_two_readings_have_no_covariance_and_no_nan():
    assert Statistics.none(2).covariance.tolist() == [[0.0, 0.0], [0.0, 0.0]]
    assert Statistics.of(np.array([[3.0]])).covariance.tolist() == [[0.0]]
    assert Statistics.of(np.zeros((0, 2))).joined(Statistics.none(2)).n == 0
