"""Samplers and minimisers against sums over every state of tiny fields.

On 3x3 cells with 4 levels the joint of labels and 12 lines has 1.07e9 states. Costs of lines
that are on and that are off add up cell by cell, so that the sum over all of them is a product
of matrices: horizontal against vertical lines. Order 2 with lines does not part so; there the
joint is 2x3 cells with 2 levels, 7 lines.
"""

from __future__ import annotations

from functools import cache
from itertools import product

import numpy as np
import pytest

from helpers_mrf import (
    assert_fits,
    counted,
    label_energies,
    label_states,
    line_states,
    patterns,
    tiny,
)
from tactile_graph_mrf.energy.state import observed_state, random_state
from tactile_graph_mrf.energy.total import energy
from tactile_graph_mrf.samplers.annealing import annealed, temperatures

pytestmark = pytest.mark.slow  # the sampler is compiled: its states are counted in thousands

BETA = 0.5


def samples(problem, n, every, seed=1):
    """States of the sampler, ``every`` sweeps apart, after a burn-in."""
    rng = np.random.default_rng(seed)
    state = random_state(problem, rng)
    annealed(problem, state, np.full(100, BETA), rng)
    for _ in range(n):
        annealed(problem, state, np.full(every, BETA), rng)
        yield state


def label_code(labels, n_levels):
    return int(labels.reshape(-1) @ n_levels ** np.arange(labels.size)[::-1])


@pytest.mark.parametrize(
    "settings",
    [
        {"lines": "none"},
        pytest.param(
            {
                "lines": "none",
                "noise": "student_t",
                "smoothness": "truncated_quadratic",
                "order": 2,
            },
            marks=pytest.mark.slow,
        ),
        {"lines": "none", "noise": "poisson", "smoothness": "huber", "order": 3},
        pytest.param({"lines": "none", "order": 3}, marks=pytest.mark.slow),
    ],
    ids=["gaussian", "student", "poisson", "order-3"],
)
def test_labels_are_drawn_from_the_gibbs_distribution(settings):
    problem = tiny(**settings)
    states = label_states(9, 4)
    energies = label_energies(problem, states)
    chances = np.exp(-BETA * (energies - energies.min()))
    # 262144 states are too many to count: by three cells at once, and by energy.
    cells = states[:, 0] + 4 * states[:, 4] + 16 * states[:, 5]
    heights = np.searchsorted(np.quantile(energies, np.linspace(0, 0.2, 30)), energies)
    seen = [label_code(s.labels, 4) for s in samples(problem, 2500, 12)]
    for groups in (cells, heights):
        n = groups.max() + 1
        assert_fits(
            np.bincount(groups[seen], minlength=n), np.bincount(groups, chances, minlength=n)
        )


@cache
def joint():
    """Partition of the 3x3 field with all lines: log Z(x), and per line that of its being on."""
    problem = tiny()
    states = label_states(9, 4)
    grid = states.reshape(-1, 3, 3)
    base = problem.own_costs()[*np.indices((3, 3)), grid].sum(axis=(1, 2))
    h_cost = problem.pairwise.smooth[np.abs(np.diff(grid, axis=1))].reshape(-1, 6)
    v_cost = problem.pairwise.smooth[np.abs(np.diff(grid, axis=2))].reshape(-1, 6)
    bits = np.array([*product((False, True), repeat=6)])
    both = np.array(
        [[patterns(problem, h.reshape(2, 3), v.reshape(3, 2)) for v in bits] for h in bits]
    )
    between = problem.model.lambda_l * both
    h_off, v_off = h_cost @ ~bits.T, v_cost @ ~bits.T
    return problem, states, base, bits, between, h_off, v_off


@pytest.mark.slow
def test_labels_and_all_lines_are_drawn_from_the_joint_distribution():
    problem, states, base, bits, between, h_off, v_off = joint()
    weights_h, weights_v = np.exp(-BETA * h_off), np.exp(-BETA * v_off)
    coupling = np.exp(-BETA * between)
    own = np.exp(-BETA * (base - base.min()))
    per_v = own[:, None] * (weights_h @ coupling) * weights_v
    labels = states[:, 4] + 4 * states[:, 5]
    centre_lines = bits[:, 2] + 2 * bits[:, 3]  # to the left and right of the cell in the middle
    chances = np.zeros((16, 4))
    for lines in range(4):
        chances[:, lines] = np.bincount(labels, per_v[:, centre_lines == lines].sum(axis=1), 16)
    counts = np.zeros((16, 4))
    on = np.zeros(12)
    for state in samples(problem, 2500, 12):
        x, v = state.labels, state.down
        counts[x[1, 1] + 4 * x[1, 2], v[1, 0] + 2 * v[1, 1]] += 1
        on += np.concatenate([state.across.ravel(), state.down.ravel()])
    assert_fits(counts.ravel(), chances.ravel())
    per_h = own[:, None] * (weights_v @ coupling.T) * weights_h
    exact = np.concatenate([per_h.sum(0) @ bits, per_v.sum(0) @ bits]) / per_v.sum()
    assert np.abs(on / 2500 - exact).max() < 4.5 * np.sqrt(0.25 / 2500)


@pytest.mark.parametrize("order", [*(pytest.param(n, marks=pytest.mark.slow) for n in (1, 2)), 3])
def test_every_joint_state_comes_up_as_often_as_it_should(order):
    problem = tiny(2, 3, 2, order=order, lambda_d=2.0)
    states = label_states(6, 2).reshape(-1, 2, 3)
    lines = [*line_states(2, 3)]
    energies = np.array([[energy(problem, x, h, v) for h, v in lines] for x in states])
    powers = 2 ** np.arange(7)[::-1]
    counts = np.zeros(energies.shape)
    for s in samples(problem, 3000, 6):
        at = np.concatenate([s.across.ravel(), s.down.ravel()]) @ powers
        counts[label_code(s.labels, 2), at] += 1
    chances = np.exp(-BETA * (energies - energies.min()))
    assert_fits(counts.ravel(), chances.ravel())


def test_marginal_lines_leave_the_labels_as_explicit_ones_do_that_do_not_meet():
    free = dict.fromkeys(("end", "straight", "corner", "tee", "cross", "parallel"), 0.0)
    marginal = tiny(2, 2, 3, lines="marginal", one=1.0, straight=0.0, lambda_l=1.3)
    explicit = tiny(2, 2, 3, **{**free, "one": 1.0, "lambda_l": 1.3})
    states = label_states(4, 3).reshape(-1, 2, 2)
    energies = np.array([[energy(explicit, x, h, v) for h, v in line_states(2, 2)] for x in states])
    chances = np.exp(-BETA * energies).sum(axis=1)
    counts = np.zeros(81)
    for s in samples(marginal, 3000, 6):
        counts[label_code(s.labels, 3)] += 1
    assert_fits(counts, chances)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_long_annealing_ends_at_the_very_minimum(seed):
    problem, _states, base, _bits, between, h_off, v_off = joint()
    # The soft minimum at a high beta lies below the minimum by less than log(4096) / beta.
    beta = 20.0
    weights_h, weights_v = np.exp(-beta * h_off), np.exp(-beta * v_off)
    per_label = ((weights_h @ np.exp(-beta * between)) * weights_v).sum(axis=1)
    soft = base - np.log(per_label + 1e-300) / beta
    near = np.flatnonzero(soft <= soft.min() + np.log(4096) / beta)
    least = min(base[x] + (h_off[x][:, None] + between + v_off[x]).min() for x in near)
    rng = np.random.default_rng(seed)
    state = random_state(problem, rng)
    trace = annealed(problem, state, 1 / temperatures("geometric", 5.0, 0.9995, 16000), rng)
    assert trace[-1] == pytest.approx(least, abs=1e-9)
    assert counted(problem, *state) == pytest.approx(least, abs=1e-9)


@pytest.mark.parametrize("smoothness", ["quadratic", "truncated_quadratic"])
def test_long_annealing_without_lines_too(smoothness):
    problem = tiny(lines="none", smoothness=smoothness)
    least = label_energies(problem, label_states(9, 4)).min()
    rng = np.random.default_rng(0)
    state = observed_state(problem)
    trace = annealed(problem, state, 1 / temperatures("geometric", 20.0, 0.99, 1500), rng)
    assert trace[-1] == pytest.approx(least, abs=1e-9)
