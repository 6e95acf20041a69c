"""The draws against the probabilities themselves."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tactile_graph_mrf.samplers.draws import (
    NEGLIGIBLE_LOG,
    draw_cost,
    draw_line,
    draw_parabola,
    weights_of_all,
)

N = 4000
EVEN = (np.arange(N) + 0.5) / N


def chances(costs, beta):
    weights = np.exp(-np.minimum(beta * (costs - costs.min()), 700))
    return weights / weights.sum()


@pytest.mark.slow  # much is compiled
@pytest.mark.parametrize("n_levels", [2, 3, 200])
@pytest.mark.parametrize("mean", [-50.0, 0.0, 0.5, 1.49, 77.3, 1e6])
@pytest.mark.parametrize("narrow", [1e-30, 1e-4, 0.05, 3.4, 1e3, 1e30])
def test_parabola_draws_share_out_even_numbers_as_the_density(n_levels, mean, narrow):
    drawn = [draw_parabola.loops(narrow / 2, mean, n_levels, 2.0, u)[0] for u in EVEN[::4]]
    counts = np.bincount(drawn, minlength=n_levels)
    centre = min(max(mean, -1e6), 1e6)
    wanted = chances((np.arange(n_levels) - centre) ** 2, narrow)
    assert len(counts) == n_levels
    assert np.abs(counts - wanted * len(drawn)).max() <= 1.001


@pytest.mark.slow
@pytest.mark.parametrize("mean", [3000.2, 4095.4, 0.0, 700.0])
@pytest.mark.parametrize("narrow", [1e-3, 1e-5, 1e-6])
def test_parabola_of_many_levels(mean, narrow):
    """Levels are gone through outwards from the likeliest: so much of the numbers is each one's."""
    n = 300
    evenly = (np.arange(n) + 0.5) / n
    drawn = [draw_parabola.loops(narrow, mean, 4096, 1.0, u)[0] for u in evenly]
    levels = np.arange(4096)
    order = np.argsort(np.abs(levels - min(math.floor(mean + 0.5), 4095)) - 0.1 * (levels > mean))
    shares = np.cumsum(np.bincount(drawn, minlength=4096)[order]) / n
    wanted = np.cumsum(chances((levels - mean) ** 2, narrow)[order])
    assert np.abs(shares - wanted).max() < 1.001 / n


@pytest.mark.parametrize("off", [-0.5, -0.2, 0.0, 0.31, 0.5])
@pytest.mark.parametrize("narrow", [1e-6, 1e-4, 0.0034, 0.05, 0.2499, 0.2501, 2.0])
@pytest.mark.parametrize(("above", "below"), [(100, 99), (0, 199), (199, 0), (30, 3), (1, 0)])
def test_the_sum_of_all_weights_is_right(off, narrow, above, below):
    k = np.arange(-below, above + 1)
    wanted = math.fsum(np.exp(-narrow * ((k + off) ** 2 - off**2)))
    factor = math.exp(-2 * narrow)
    up, down = (math.exp(-narrow * (1 + s * 2 * off)) for s in (1, -1))
    got = weights_of_all.loops(narrow, off, up, down, factor, above, below)
    assert got == pytest.approx(wanted, rel=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("beta", [1e-12, 0.01, 1.0, 1e12])
def test_cost_draws_share_out_even_numbers_as_the_density(beta):
    costs = np.random.default_rng(1).normal(size=37) * 30
    kept = np.empty(37, np.int64)
    drawn = [draw_cost.loops(costs.copy(), kept, beta, u)[0] for u in EVEN]
    counts = np.bincount(drawn, minlength=37)
    assert np.abs(counts - chances(costs, beta) * N).max() <= 1.001


@pytest.mark.slow
def test_a_draw_is_sure_only_if_no_number_gives_another():
    kept = np.empty(2, np.int64)
    for gap in (1.0, 30.0, 36.0, 60.0):
        draws = {
            draw_cost.loops(np.array([gap, 0.0]), kept, 1.0, u) for u in (0.0, 0.5, 1 - 2**-53)
        }
        assert all(not sure for _, sure in draws) or draws == {(1, True)}
        assert draw_parabola.loops(gap, 5.0, 9, 1.0, 1 - 2**-53)[1] == (gap > 40)


@pytest.mark.parametrize("rise", [-2.0, 0.0, 0.3, 5.0])
def test_lines_are_on_with_their_probability(rise):
    on = sum(draw_line.loops(rise, 1.5, u)[0] for u in EVEN)
    assert abs(on / N - 1 / (1 + math.exp(1.5 * rise))) <= 1.001 / N


def test_hopeless_lines_need_no_number():
    assert draw_line.loops(NEGLIGIBLE_LOG * 1.1, 1.0, 0.0) == (False, True)
    assert draw_line.loops(-1e30, 1e12, 0.999) == (True, True)
