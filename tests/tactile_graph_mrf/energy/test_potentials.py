"""Costs against the distributions they stand for."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from tactile_graph_mrf.energy.potentials import data_costs, pattern_costs, smoothness_costs

LEVELS = np.arange(50.0)
OBSERVED = np.array([0.0, 7.0, 49.0])


def costs(noise, zero_level=0.0):
    return data_costs(
        noise, OBSERVED, 50, sigma=3.0, freedom=4.0, outlier_share=0.1, zero_level=zero_level
    )


@pytest.mark.parametrize(
    ("noise", "density"),
    [
        ("gaussian", lambda g, x: stats.norm.logpdf(g, x, 3.0)),
        ("laplace", lambda g, x: stats.laplace.logpdf(g, x, 3.0 / np.sqrt(2))),
        ("student_t", lambda g, x: stats.t.logpdf(g, 4.0, x, 3.0)),
        ("outliers", lambda g, x: np.log(0.9 * stats.norm.pdf(g, x, 3.0) + 0.1 / 50)),
    ],
)
def test_costs_are_minus_twice_the_variance_times_the_log_density(noise, density):
    for row, g in zip(costs(noise), OBSERVED, strict=True):
        wanted = -2 * 9.0 * density(g, LEVELS)
        np.testing.assert_allclose(np.diff(row), np.diff(wanted), atol=1e-9)


def test_poisson_costs_differ_as_the_poisson_log_likelihood():
    for row, g in zip(costs("poisson"), OBSERVED, strict=True):
        mean = LEVELS + 1
        wanted = -2 * 25.5 * ((g + 1) * np.log(mean) - mean)
        np.testing.assert_allclose(np.diff(row), np.diff(wanted), atol=1e-8)
    assert (costs("poisson", -30.0) >= 0).all()


def test_poisson_and_gaussian_agree_at_half_range():
    near = data_costs(
        "poisson", np.array([1000.0]), 2001, sigma=1, freedom=1, outlier_share=0.5, zero_level=0
    )
    np.testing.assert_allclose(near[0, 1010], 100.0, rtol=0.01)


def test_smoothness_bends_at_the_truncation():
    of = {
        kind: smoothness_costs(kind, 10, 3.0)
        for kind in (
            *("quadratic", "truncated_quadratic", "absolute", "truncated_absolute"),
            *("huber", "geman_mcclure"),
        )
    }
    assert of["quadratic"][5] == 25
    assert of["truncated_quadratic"].tolist() == [0, 1, 4, 9, 9, 9, 9, 9, 9, 9]
    assert of["absolute"][5] == 5
    assert of["truncated_absolute"].tolist() == [0, 1, 2, 3, 3, 3, 3, 3, 3, 3]
    assert of["huber"].tolist() == [0, 1, 4, 9, 15, 21, 27, 33, 39, 45]
    np.testing.assert_allclose(of["geman_mcclure"][3], 4.5)


def test_a_pattern_is_known_by_the_lines_that_meet():
    costs = pattern_costs(1.0, 2.0, 3.0, 4.0, 5.0)
    assert costs.tolist() == [0, 1, 1, 2, 1, 3, 3, 4, 1, 3, 3, 4, 2, 4, 4, 5]
