"""The effective size of chains whose autocorrelation is known."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph_mrf.samplers.effective_size import effective_size


def chain(persistence, n=20000, seed=0):
    rng = np.random.default_rng(seed)
    x = np.empty(n)
    x[0] = rng.normal()
    for k in range(1, n):
        x[k] = persistence * x[k - 1] + np.sqrt(1 - persistence**2) * rng.normal()
    return x


@pytest.mark.parametrize("persistence", [0.0, 0.5, 0.9])
def test_it_is_that_of_an_autoregressive_chain(persistence):
    wanted = 20000 * (1 - persistence) / (1 + persistence)
    got = effective_size(chain(persistence)[:, None])
    assert got == pytest.approx(wanted, rel=0.12)


def test_the_worst_column_counts_and_still_ones_do_not():
    columns = np.column_stack([chain(0.0), chain(0.9), np.ones(20000)])
    assert effective_size(columns) == effective_size(columns[:, 1:2])
    assert effective_size(np.ones((50, 2))) == 50


def test_it_lies_between_one_and_all_and_huge_numbers_do_no_harm():
    assert effective_size(np.arange(100.0)[:, None] * 1e300) >= 1
    assert effective_size((-1.0) ** np.arange(100)[:, None]) == 100
    assert effective_size(np.array([[1.0], [2.0]])) == 2
