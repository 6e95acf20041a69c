from itertools import permutations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from tactile_graph_tracking.pairing import FEW_PAIRS, paired, paired_places

LIMIT = 2.0


def total(cost, pairs):
    """Return what a pairing costs, rows that stay alone included."""
    return sum(cost[pair] for pair in pairs) + LIMIT * (len(cost) - len(pairs))


def best_total(cost):
    """Return the least cost of all pairings there are."""
    rows, columns = cost.shape
    places = [*range(columns), *[None] * rows]
    return min(
        total(cost, [(i, j) for i, j in enumerate(chosen) if j is not None])
        for chosen in set(permutations(places, rows))
    )


costs = st.tuples(st.integers(1, 3), st.integers(1, 3)).flatmap(
    lambda shape: arrays(float, shape, elements=st.sampled_from([0.0, 0.5, 1.0, 1.9, 3.0, np.inf]))
)


@pytest.mark.slow
@settings(max_examples=100, deadline=None)
@given(costs)
def test_no_other_pairing_is_cheaper_and_nobody_is_paired_twice(cost):
    pairs = paired(cost, LIMIT)
    assert len({i for i, _ in pairs}) == len({j for _, j in pairs}) == len(pairs)
    assert all(cost[pair] <= LIMIT for pair in pairs)
    assert total(cost, pairs) == pytest.approx(best_total(cost))


def test_a_conflict_is_solved_for_the_sum_not_for_the_first():
    assert paired(np.array([[0.1, 0.2], [0.0, 1.9]]), LIMIT) == [(0, 1), (1, 0)]


@pytest.mark.parametrize("shape", [(0, 0), (0, 3), (3, 0)])
def test_nobody_or_nothing_makes_no_pairs(shape):
    assert paired(np.zeros(shape), LIMIT) == []


@pytest.mark.parametrize("gate", [0.3, 2.0, 100.0])
def test_many_places_are_paired_as_well_as_all_at_once(gate):
    rng = np.random.default_rng(4)
    true, got = rng.uniform(0, 40, (90, 2)), rng.uniform(0, 40, (80, 2))
    got[:60] = true[10:70] + rng.normal(0, 0.2, (60, 2))
    assert len(true) * len(got) > FEW_PAIRS
    alone = gate * (2.0 + len(true))
    off = np.hypot(*(true[:, None] - got[None]).transpose(2, 0, 1))
    at_once = paired(np.where(off <= gate, off, np.inf), alone)
    found = paired_places(true, got, gate, alone)
    assert found == sorted(found)
    assert [(i, j) for i, j, _ in found] == at_once
    assert [error for *_, error in found] == [off[pair] for pair in at_once]
