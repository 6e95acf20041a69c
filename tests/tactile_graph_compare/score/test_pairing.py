"""Pairs are most in number, then least in sum, as an exhaustive search finds them."""

from __future__ import annotations

from itertools import permutations

import numpy as np
import pytest

from tactile_graph_compare.score.pairing import assignment, paired


def best_by_trying_all(cost):
    rows, columns = cost.shape
    return min(
        sum(cost[i, j] for i, j in enumerate(chosen))
        for chosen in permutations(range(columns), rows)
    )


@pytest.mark.parametrize("seed", range(40))
def test_an_assignment_costs_no_more_than_any_other(seed):
    rng = np.random.default_rng(seed)
    rows = int(rng.integers(1, 6))
    cost = rng.integers(0, 8, (rows, rows + int(rng.integers(0, 3)))).astype(float)  # many ties
    chosen = assignment(cost)
    assert len(set(chosen)) == rows
    assert sum(cost[i, j] for i, j in enumerate(chosen)) == best_by_trying_all(cost)


@pytest.mark.parametrize("seed", range(40))
def test_pairs_are_as_many_as_can_be_within_the_gate_and_then_the_nearest(seed):
    rng = np.random.default_rng(seed)
    n_true, n_found = map(int, rng.integers(0, 5, 2))
    off = rng.uniform(0, 4, (n_true, n_found))
    pairs = paired(off, 2.0)
    got = (len(pairs), -sum(off[i, j] for i, j in pairs))
    assert all(off[i, j] <= 2.0 for i, j in pairs)
    assert len({j for _, j in pairs}) == len({i for i, _ in pairs}) == len(pairs)
    places = [*range(n_found), *[None] * n_true]
    best = max(
        (len(kept), -sum(off[i, j] for i, j in kept))
        for chosen in permutations(places, n_true)
        if (kept := [(i, j) for i, j in enumerate(chosen) if j is not None and off[i, j] <= 2.0])
        is not None
    )
    assert got == pytest.approx(best)
