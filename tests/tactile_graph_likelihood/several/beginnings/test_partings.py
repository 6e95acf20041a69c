"""Pairs of sketches for what is touched."""

import math

import numpy as np
import pytest

from helpers_joint import DISCS, problem_of_discs
from tactile_graph_likelihood.several.beginnings.partings import (
    ANGLES,
    across,
    partings,
    sketch_of,
)
from tactile_graph_likelihood.single.density.element_terms import ON

pytestmark = pytest.mark.usefixtures("plain_kernels")


@pytest.mark.slow  # plain code takes some seconds
def test_the_best_pair_of_sketches_lies_where_two_discs_do():
    problem = problem_of_discs()
    found, evidence = np.empty((3, 2, 6)), np.empty(3)
    partings.call(problem, problem.states == ON, 4, found, evidence)
    best = found[int(evidence.argmax())]
    best = best[best[:, 0].argsort()]
    assert np.hypot(*(best - DISCS)[:, :2].T).max() < 0.5
    assert np.exp(best[:, 2:4]) == pytest.approx(2.4, abs=0.5)


def test_too_few_elements_have_no_pair():
    problem = problem_of_discs()
    mask = np.zeros((16, 16), bool)
    mask[4, 4:8] = True
    found, evidence = np.empty((2, 2, 6)), np.empty(2)
    partings.call(problem, mask, 4, found, evidence)
    assert (evidence == -math.inf).all()


def test_elements_come_in_order_at_each_angle():
    mask = np.zeros((6, 6), bool)
    mask[1, 1] = mask[1, 4] = mask[4, 2] = True
    piece = across.call(mask)
    assert piece.order.shape == (ANGLES, 3)
    mask |= np.random.default_rng(1).random((6, 6)) < 0.6
    piece = across.call(mask)
    assert (np.stack([piece.row, piece.column]) == np.nonzero(mask)).all()
    assert (piece.order == piece.along.argsort(axis=1, kind="stable")).all()


def test_a_sketch_has_the_moments_of_its_elements():
    rows, columns = np.nonzero(np.ones((3, 9), bool))
    sums = [27, columns.sum(), rows.sum(), (columns**2).sum(), (rows * columns).sum()]
    point = np.zeros(6)
    sums = np.array([*sums, (rows**2).sum(), 27 * 4.2], float)
    sketch_of.call(sums, np.array([0.0, 0.0, 1.0, 1.0, 0.0, 0.0]), point)
    assert point[:2] == pytest.approx([4.5, 1.5])
    assert np.exp(point[2:4]) == pytest.approx([4.86, 1.62], abs=0.01)
    assert point[4:] == pytest.approx([0.0, 4.2])
