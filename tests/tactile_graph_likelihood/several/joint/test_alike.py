"""How much likelier sizes and loads that resemble each other are on one pad."""

import math

import numpy as np
import pytest
from scipy.stats import norm

from tactile_graph_likelihood.several.joint.alike import SPREADS, alikeness, log_alike

PRIOR = np.array([0.0, 0.0, 20.5, 20.5, 1.0, 12.0, 1.0, 0.0, 0.0, 4.5, 1.5])


def test_the_density_is_that_of_normals_of_any_spread_integrated_over_their_mean():
    values = np.array([0.7, 1.1, 0.6])
    off = values[:, None] - np.linspace(-9.0, 11.0, 2001)
    each = [norm.pdf(off, scale=spread).prod(axis=0).sum() * 0.01 for spread in SPREADS]
    assert log_alike.call(values) == pytest.approx(math.log(np.mean(each)), abs=1e-3)


def test_one_outline_is_as_likely_as_by_itself():
    assert alikeness.call(np.array([0.9]), np.array([7.0]), PRIOR) == 0.0


def test_alike_ones_gain_with_their_number_and_unlike_ones_lose():
    gains = [alikeness.call(np.full(n, 0.8), np.full(n, 4.4), PRIOR) for n in (2, 3, 6)]
    assert 1.0 < gains[0] < gains[1] < gains[2] < 20.0
    assert alikeness.call(np.array([0.0, 2.4]), np.array([3.0, 6.5]), PRIOR) < 0.0


def test_a_common_change_of_all_sizes_changes_nothing():
    sizes, loads = np.array([0.3, 0.5, 0.9]), np.array([4.0, 4.2, 5.0])
    assert alikeness.call(sizes + 0.7, loads, PRIOR) == pytest.approx(
        alikeness.call(sizes, loads, PRIOR)
    )
