"""Whose each touched element is."""

import numpy as np
import pytest

from helpers_joint import DISCS, problem_of_discs
from tactile_graph_likelihood.geometry.outlines import DISC
from tactile_graph_likelihood.several.joint.joint_posterior import Outlines, add_outline
from tactile_graph_likelihood.several.joint.whose import unexplained_by, whose_by_outlines
from tactile_graph_likelihood.single.density.element_terms import ON

pytestmark = pytest.mark.usefixtures("plain_kernels")

BOTH = Outlines(np.full(2, DISC), np.zeros(2, np.int64), DISCS)


def touched_at(problem, *places):
    """Return a problem in which some elements more are touched."""
    states, logs = problem.states.copy(), problem.logs.copy()
    for place in places:
        states[place], logs[place] = ON, 4.0
    return problem._replace(states=states, logs=logs)


def test_an_element_is_the_outlines_that_brings_most():
    problem = problem_of_discs()
    loads = []
    for k in range(2):
        its = problem._replace(load=np.zeros((16, 16)), share=np.zeros((16, 16)))
        add_outline.call(its, BOTH, k)
        loads.append(its.load)
    own, unexplained = whose_by_outlines.call(problem, BOTH)
    on = problem.states == ON
    assert (own[on] == np.argmax(loads, axis=0)[on]).all()
    assert (own[~on] == -1).all()
    assert (unexplained == unexplained_by.call(problem, sum(loads), False)).all()
    assert np.abs(problem.load).max() == 0.0


def test_one_that_none_covers_is_the_nearest_ones_within_two_cells():
    bare = problem_of_discs()
    column = int(np.flatnonzero((bare.states == ON).any(axis=0))[-1])
    row = int(np.flatnonzero(bare.states[:, column] == ON)[0])
    near, far = (row, column + 2), (14, 1)
    own, _ = whose_by_outlines.call(touched_at(bare, near, far), BOTH)
    assert own[near] == 1
    assert own[far] == -1
    next_to_it = row, column + 4
    own, _ = whose_by_outlines.call(touched_at(bare, near, next_to_it), BOTH)
    assert own[next_to_it] == 1
