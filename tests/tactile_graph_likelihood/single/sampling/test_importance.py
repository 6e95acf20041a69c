"""Even points and their weights."""

import math

import numpy as np
import pytest

from helpers_modes import plainly
from tactile_graph_likelihood.geometry.linear import cholesky, inverted, solved
from tactile_graph_likelihood.single.sampling.even_points import even_points
from tactile_graph_likelihood.single.sampling.importance import FREEDOM, normal_points, weigh


def test_even_points_have_the_moments_of_students_t():
    points = even_points(20_000, 4, 0)
    np.testing.assert_allclose(points.mean(axis=0), 0.0, atol=1e-12)
    expected = FREEDOM / (FREEDOM - 2.0) * np.eye(4)
    np.testing.assert_allclose(np.cov(points.T), expected, atol=0.06)


@pytest.mark.slow
def test_even_points_are_more_even_than_random_ones():
    even = [np.tanh(even_points(64, 4, seed)).var(axis=0) for seed in range(40)]
    rng = np.random.default_rng(0)
    random = np.tanh(rng.standard_t(FREEDOM, (40, 64, 4))).var(axis=1)
    assert np.std(even) < 0.7 * np.std(random)
    assert np.mean(even) == pytest.approx(np.mean(random), rel=0.05)


def test_equal_seeds_give_equal_points_and_other_seeds_others():
    np.testing.assert_array_equal(even_points(32, 3, 5), even_points(32, 3, 5))
    assert not np.allclose(even_points(32, 3, 5), even_points(32, 3, 6))


@pytest.mark.parametrize("which", ["reference", "compiled"])
def test_weights_are_density_over_the_mixture(which):
    logs_p = np.array([0.0, math.log(2.0), -math.inf, 1.0])
    q = np.array([[0.1, 0.4, 0.2, 0.5], [0.3, 0.2, 0.2, 0.1]])
    weights = np.empty(4)
    shares = np.array([0.75, 0.25])
    level, equal = getattr(weigh, which)(logs_p, q, shares, 2, 4, weights)
    raw = np.exp(logs_p) / (shares @ q)
    np.testing.assert_allclose(weights, raw / raw.sum())
    assert level == pytest.approx(math.log(raw.mean()))
    assert equal == pytest.approx(raw.sum() ** 2 / (raw**2).sum())


@pytest.mark.parametrize("which", ["reference", "compiled"])
def test_small_matrices(which):
    rng = np.random.default_rng(0)
    a = rng.normal(size=(5, 5))
    matrix, root, x = a @ a.T, np.empty((5, 5)), np.empty(5)
    assert getattr(cholesky, which)(matrix, root)
    np.testing.assert_allclose(root @ root.T, matrix)
    getattr(solved, which)(root, np.arange(5.0), x)
    np.testing.assert_allclose(matrix @ x, np.arange(5.0), atol=1e-9)
    np.testing.assert_allclose(getattr(inverted, which)(root) @ matrix, np.eye(5), atol=1e-8)
    assert not getattr(cholesky, which)(-matrix, root)


@pytest.mark.parametrize("n", [1, 4, 7])
def test_normal_points_spread_as_the_inverse_of_what_is_known(n):
    rng = np.random.default_rng(n)
    root = np.tril(rng.standard_normal((7, 7))) + 3.0 * np.eye(7)
    p, steps = rng.standard_normal(7), rng.standard_normal((32, n))
    mean, points, covariance = plainly(normal_points)(p, root, steps, np.zeros(n))
    np.testing.assert_array_equal(mean, p[:n])
    known = root[:n, :n] @ root[:n, :n].T
    np.testing.assert_allclose(covariance, np.linalg.inv(known), rtol=1e-9, atol=1e-14)
    # each step of Student's t becomes one of the same length in standard deviations
    lengths = ((points - p[:n]) @ known * (points - p[:n])).sum(axis=1)
    np.testing.assert_allclose(lengths, (1.0 - 2.0 / FREEDOM) * (steps**2).sum(axis=1), rtol=1e-9)
    pull = rng.standard_normal(n)
    moved, others, same = plainly(normal_points)(p, root, steps, pull)
    np.testing.assert_allclose(known @ (moved - mean), pull, atol=1e-9)
    np.testing.assert_allclose(others - points, np.tile(moved - mean, (32, 1)), atol=1e-12)
    np.testing.assert_array_equal(same, covariance)
