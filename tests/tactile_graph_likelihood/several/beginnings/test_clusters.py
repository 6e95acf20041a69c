"""Touched elements are gathered in so many clusters, and sketches of them climbed from."""

import numpy as np
import pytest

from helpers_joint import DISCS, problem_of_discs
from tactile_graph_likelihood.several.beginnings import clusters
from tactile_graph_likelihood.several.beginnings.clusters import (
    clustered,
    elements_of,
    farthest,
    gathered,
    same_places,
)

pytestmark = pytest.mark.usefixtures("plain_kernels")

ROWS, COLUMNS = np.mgrid[0:20, 0:20]
MIDDLES = [(4.0, 4.0), (9.0, 4.0), (14.0, 4.0), (4.0, 9.0), (9.0, 9.0), (14.0, 9.0)]


def gathered_in(mask, count, first=0, least=4):
    """Return whose each element is, and whether all clusters are large enough."""
    logs = np.arange(400.0).reshape(20, 20)
    at, log = elements_of.call(mask, logs)
    assert (log == logs[mask]).all()
    assert (at == np.column_stack(np.nonzero(mask))[:, ::-1]).all()
    own, sums = np.empty(len(at), np.int64), np.empty((count, 7))
    enough = gathered.call(at, log, first, least, own, sums)
    return at, own, sums, enough


def test_six_discs_that_touch_are_six_clusters_from_some_of_twelve_elements():
    mask = np.logical_or.reduce([np.hypot(COLUMNS - x, ROWS - y) < 2.6 for x, y in MIDDLES])
    right = 0
    for first in range(0, int(mask.sum()), 9):
        at, own, sums, enough = gathered_in(mask, 6, first)
        if not enough:
            continue
        middles = sums[:, 1:3] / sums[:, :1]
        far = np.hypot(*(middles[:, None] - MIDDLES).transpose(2, 0, 1))
        right += far.min(axis=0).max() < 0.5
        assert (sums[:, 0] == np.bincount(own)).all()
        assert sums[2, 3] == pytest.approx((at[own == 2, 0] ** 2).sum())
    assert right >= 3


def test_ellipses_part_a_long_one_from_a_round_one_better_than_middles_do(monkeypatch):
    long, disc = (abs(COLUMNS - 9) < 9) & (abs(ROWS - 3) < 2), np.hypot(COLUMNS - 9, ROWS - 8) < 3
    shares = []
    for rounds in (0, clusters.OVAL_ROUNDS):
        monkeypatch.setattr(clusters, "OVAL_ROUNDS", rounds)
        best = 0.0
        for first in range(0, int((long | disc).sum()), 5):
            at, own, _, _ = gathered_in(long | disc, 2, first)
            is_long = long[at[:, 1].astype(int), at[:, 0].astype(int)]
            best = max(best, *(float(np.mean(is_long == (own == k))) for k in range(2)))
        shares.append(best)
    assert shares[1] > shares[0] + 0.05


def test_clusters_of_too_few_elements_are_none():
    mask = (COLUMNS < 3) & (ROWS < 3)
    assert gathered_in(mask, 2, least=3)[3]
    assert not gathered_in(mask, 3, least=4)[3]
    mask[15, 15] = True
    assert not gathered_in(mask, 2, least=2)[3]


def test_middles_begin_far_from_each_other():
    at = np.array([[0.0, 0.0], [1.0, 0.0], [9.0, 0.0], [0.0, 5.0]])
    assert (farthest.call(at, 1, 3) == at[[1, 2, 3]]).all()


def test_sketches_at_the_same_places_are_the_same_in_any_order():
    some = np.array([[1.0, 2.0], [5.0, 3.0]])
    assert same_places.call(some, some[::-1] + 0.01, 0.05)
    assert not same_places.call(some, some + np.array([[0.0], [0.1]]), 0.05)


@pytest.mark.slow
def test_two_discs_are_found_from_clusters_and_too_few_elements_are_not():
    problem = problem_of_discs(2)
    on, found, logs = problem.states == 1, np.empty((3, 2, 6)), np.empty(3)
    assert on.any()
    clustered.call(problem, on, 4, 4, found, logs)
    assert logs[0] > -np.inf
    two = found[int(np.argmax(logs))]
    two = two[two[:, 0].argsort()]
    assert np.hypot(*(two - DISCS)[:, :2].T).max() < 0.5
    clustered.call(problem, on, 1000, 4, found, logs)
    assert (logs == -np.inf).all()
