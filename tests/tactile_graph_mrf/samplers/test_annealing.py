"""Temperatures of the annealing schedules."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph_mrf.samplers.annealing import temperatures


def test_geometric_is_the_thesis():
    got = temperatures("geometric", 5.0, 0.9, 110)
    np.testing.assert_allclose(got[:3], [5.0, 4.5, 4.05])
    assert got[-1] == pytest.approx(5.0 * 0.9**109)


def test_logarithmic_starts_at_the_first_and_falls_as_one_over_a_logarithm():
    got = temperatures("logarithmic", 5.0, 0.9, 100)
    assert got[0] == pytest.approx(5.0)
    assert got[-1] == pytest.approx(5.0 * np.log(2) / np.log(101))


@pytest.mark.parametrize("kind", ["geometric", "logarithmic", "linear"])
@pytest.mark.parametrize("first", [1e-6, 1e12])
def test_temperatures_fall_and_stay_above_zero(kind, first):
    got = temperatures(kind, first, 1e-3, 5000)
    assert (np.diff(got) <= 0).all()
    assert got[-1] > 0
    assert np.isfinite(1e12 / got).all()


def test_linear_falls_in_even_steps():
    np.testing.assert_allclose(temperatures("linear", 4.0, 0.9, 4), [4, 3, 2, 1])
