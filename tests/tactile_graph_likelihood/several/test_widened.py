"""Points of a posterior spread to another covariance, and what is next to what."""

import numpy as np
import pytest

from tactile_graph_likelihood.several.beginnings.ladder import dilated, left_near, neighbours
from tactile_graph_likelihood.several.posteriors import spread_by, widened

pytestmark = pytest.mark.usefixtures("plain_kernels")


def positive(rng, n):
    root = rng.normal(size=(n, n))
    return root @ root.T + n * np.eye(n)


def covariance_of(points, weights):
    off = points - weights @ points
    return (off * weights[:, None]).T @ off / (1.0 - weights @ weights)


def test_points_get_the_others_doubt_and_that_between_kinds():
    rng = np.random.default_rng(0)
    weights = rng.uniform(0.5, 1.0, 40)
    weights /= weights.sum()
    points, alone, together = rng.normal(size=(40, 4)), positive(rng, 4), positive(rng, 4)
    spread, shift = 0.3 * positive(rng, 4), rng.normal(size=4)
    found = widened.call(points, weights, alone, together, spread, shift)
    turned = np.linalg.cholesky(together) @ np.linalg.inv(np.linalg.cholesky(np.linalg.inv(alone)))
    mean = weights @ points
    expected = covariance_of((points - mean) @ turned.T, weights) + spread
    assert found.mean == pytest.approx(mean + shift)
    assert found.covariance == pytest.approx(expected)
    assert weights @ found.points == pytest.approx(mean + shift)
    assert covariance_of(found.points, weights) == pytest.approx(expected)


def test_points_on_one_line_stay_as_they_are():
    off = np.outer(np.linspace(-1.0, 1.0, 9), [1.0, 2.0])
    before = off.copy()
    spread_by.call(off, off.T @ off / 9.0, np.eye(2))
    assert (off == before).all()


def test_neighbours_are_those_whose_wider_masks_meet():
    rng = np.random.default_rng(1)
    own = np.full((9, 11), -1)
    own[1:4, 1:4], own[1:4, 5:8], own[5:8, 8:11] = 0, 1, 2
    own[4, 4] = 0
    unexplained = rng.uniform(size=own.shape)
    wide = [dilated(own == k) for k in range(3)]
    near = left_near.call(own, unexplained, 3)
    for a in range(3):
        for b in range(a):
            assert bool(near[b, a]) == bool((wide[a] & wide[b]).any())
            assert near[a, b] == pytest.approx(unexplained[wide[a] | wide[b]].sum())
    assert [pair for pair, *_ in neighbours(own, unexplained, 3)] == sorted(
        [(1, 0), (2, 1)], key=lambda pair: -near[pair]
    )
