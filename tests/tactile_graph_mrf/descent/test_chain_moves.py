"""Moves of chains: what is proposed, and that the best of all ways through it is found."""

from __future__ import annotations

import math
from itertools import product

import numpy as np
import pytest

from helpers_modes import plainly
from helpers_mrf import tiny
from tactile_graph.wires import Image
from tactile_graph_mrf.descent.chain_moves import (
    PROPOSALS,
    Chain,
    best_way,
    held_costs,
    propose,
)
from tactile_graph_mrf.energy.model import Model
from tactile_graph_mrf.energy.problem import Problem, prepare
from tactile_graph_mrf.energy.state import State
from tactile_graph_mrf.energy.total import energy

pytestmark = pytest.mark.usefixtures("plain_kernels")


def chain_of(number: int, along_rows: bool, length: int) -> Chain:
    numbers, costs = np.zeros((2, length, PROPOSALS), np.int64), np.zeros((length, PROPOSALS))
    return Chain(number, along_rows, numbers[0], np.zeros(length, np.int64), costs, numbers[1])


def lined(problem: Problem, seed: int = 4) -> State:
    rng = np.random.default_rng(seed)
    rows, columns = problem.shape
    labels = rng.integers(0, problem.n_levels, problem.shape)
    return State(
        labels, rng.random((rows - 1, columns)) < 0.3, rng.random((rows, columns - 1)) < 0.3
    )


def proposed(problem: Problem, labels: np.ndarray, i: int, j: int) -> list[int]:
    """Own label, the neighbours', one less, one more, the datum, and the mean, each once."""
    top, x = problem.n_levels - 1, int(labels[i, j])
    near = [(i - 1, j), (i + 1, j), (i, j - 1), (i, j + 1)]
    inside = [at for at in near if 0 <= at[0] <= top and min(at) >= 0
              and at[0] < labels.shape[0] and at[1] < labels.shape[1]]  # fmt: skip
    theirs = [int(labels[at]) for at in inside]
    smooth = problem.pairwise.smooth
    mass, total = 1.0, float(problem.observed[i, j])
    for y in theirs:
        d = max(abs(x - y), 1)
        weight = max(smooth[min(d + 1, top)] - smooth[d - 1], 0.0) / (4.0 * d)
        mass, total = mass + weight, total + weight * y
    rounded = [math.floor(v + 0.5) for v in (problem.observed[i, j], total / mass)]
    every = [x, *theirs, x - 1, x + 1, *rounded]
    return list(dict.fromkeys(min(max(y, 0), top) for y in every))


@pytest.mark.parametrize("along_rows", [True, False])
def test_what_is_proposed(along_rows: bool) -> None:
    problem = tiny(3, 4, n_levels=9, smoothness="quadratic")
    labels = lined(problem).labels
    for number in range(3 if along_rows else 4):
        chain = chain_of(number, along_rows, 4 if along_rows else 3)
        propose(problem.potentials, problem.observed, labels, chain)
        for s, n in enumerate(chain.kinds):
            at = (number, s) if along_rows else (s, number)
            assert chain.proposals[s, :n].tolist() == proposed(problem, labels, *at), at


@pytest.mark.parametrize("seed", [4, 5, 6])
@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize(("number", "along_rows"), [(0, True), (2, True), (0, False), (1, False)])
def test_no_way_through_the_proposals_is_better(
    number: int, along_rows: bool, order: int, seed: int
) -> None:
    problem = tiny(3, 3, n_levels=5, order=order, smoothness="truncated_quadratic")
    state = lined(problem, seed)
    chain = chain_of(number, along_rows, 3)
    propose(problem.potentials, problem.observed, state.labels, chain)
    plainly(held_costs)(problem.potentials, state, chain)
    a = plainly(best_way)(problem.potentials, state, chain)
    cells = [(number, s) if along_rows else (s, number) for s in range(3)]
    every: dict[int, list[float]] = {}
    for some in product(*(chain.proposals[s, : chain.kinds[s]] for s in range(3))):
        labels = state.labels.copy()
        for at, y in zip(cells, some, strict=True):
            labels[at] = y
        found = energy(problem, labels, state.across, state.down)
        every.setdefault(int(some[-1]), []).append(found)
    ends = chain.proposals[2, : chain.kinds[2]].tolist()
    off = chain.best[2, : chain.kinds[2]] - [min(every[y]) for y in ends]
    np.testing.assert_allclose(off, off[0], atol=1e-9)
    way = state.labels.copy()
    for s in range(2, -1, -1):
        way[cells[s]] = chain.proposals[s, a]
        a = chain.came[s, a]
    assert energy(problem, way, state.across, state.down) == pytest.approx(
        min(min(some) for some in every.values())
    )


def test_of_equal_ways_the_present_labels_stay() -> None:
    problem = tiny(2, 3, n_levels=3, lambda_d=0.0, lines="none")
    chain = chain_of(0, True, 3)
    chain.kinds[:] = 3
    state = State(np.zeros((2, 3), np.int64), np.zeros((1, 3), bool), np.zeros((2, 2), bool))
    assert plainly(best_way)(problem.potentials, state, chain) == 0
    assert not chain.came.any()


@pytest.mark.parametrize("expected", [None, 6.0])
def test_the_mean_proposed_is_of_what_the_unary_cost_is_least_at(expected: float | None) -> None:
    """Of data and expected load together; without either, what is read there."""
    values = np.array([[0.0, 8.0, 2.0]])
    wanted = None if expected is None else Image(np.full((1, 3), expected))
    model = Model(n_levels=9, lines="none", lambda_prior=3.0, lambda_d=0.01)
    problem = prepare(model, Image(values), None, wanted)
    chain = chain_of(0, True, 3)
    propose(problem.potentials, problem.observed, np.array([[4, 4, 4]]), chain)
    _, curvature, centre, _, _ = problem.potentials.unary
    bend = problem.pairwise.smooth[1]
    for s, n in enumerate(chain.kinds):
        beside = (s > 0) + (s < 2)
        weight = beside * bend / 4.0
        mean = (curvature[0, s] * centre[0, s] + 4.0 * weight) / (curvature[0, s] + weight)
        assert math.floor(mean + 0.5) in chain.proposals[s, :n].tolist()
