"""Sketches of each number: what they leave unexplained, and which lie next to each other."""

import numpy as np
import pytest
from scipy.special import ndtr

from helpers_joint import DISCS, problem_of_discs
from tactile_graph_likelihood.geometry.outlines import DISC, RECTANGLE
from tactile_graph_likelihood.several.beginnings.ladder import Ladder, dilated, neighbours
from tactile_graph_likelihood.several.joint.joint_posterior import Outlines, add_outline
from tactile_graph_likelihood.several.joint.whose import ODD
from tactile_graph_likelihood.single.density.element_terms import (
    LEAST,
    SIGMA,
    UNKNOWN,
    VOIDS,
    on_level,
)

pytestmark = pytest.mark.usefixtures("plain_kernels")

KINDS = [(DISC, 0), (RECTANGLE, 0)]


def load_of(problem, discs):
    lain = problem._replace(load=0.0 * problem.load, share=0.0 * problem.load)
    for k in range(len(discs)):
        add_outline.call(lain, Outlines(np.full(2, DISC), np.zeros(2, np.int64), discs), k)
    return lain.load


def test_what_outlines_explain_leaves_little_and_what_they_miss_leaves_much():
    problem = problem_of_discs(3)
    ladder = Ladder(problem, KINDS, 3.0, 1.0)
    both = ladder.unexplained(load_of(problem, DISCS))
    one = ladder.unexplained(load_of(problem, DISCS[:1]))
    right = np.zeros((16, 16), bool)
    right[:, 7:] = True
    assert (both >= 0.0).all()
    assert one[right].sum() > both[right].sum() + 40.0
    unknown = np.full_like(problem.states, UNKNOWN)
    assert not Ladder(problem._replace(states=unknown), KINDS, 3.0, 1.0).unexplained(both).any()


def test_what_is_left_unexplained_is_what_an_explanation_would_add():
    problem = problem_of_discs(3)
    ladder, load = Ladder(problem, KINDS, 3.0, 1.0), load_of(problem, DISCS)
    sigma, voids, least = (problem.noise[k] for k in (SIGMA, VOIDS, LEAST))
    mu = np.log(np.maximum(load, 1e-9))
    half = 0.5 * ((problem.logs - mu) / sigma) ** 2
    on = np.where(half > ODD, np.minimum(half, on_level.call(problem.noise)), 0.0)
    off = -np.log1p(-(1.0 - voids) * ndtr((mu - least) / sigma))
    assert ladder.unexplained(load) == pytest.approx(np.where(ladder.on, on, off))


def test_true_outlines_leave_no_more_unexplained_than_usual_and_others_do():
    surplus = []
    for seed in range(20):
        ladder = Ladder(problem_of_discs(seed), KINDS, 3.0, 1.0)
        surplus.append(ladder.surplus(load_of(ladder.problem, DISCS)))
        assert ladder.surplus(load_of(ladder.problem, DISCS[:1])) > 20.0
    assert abs(np.mean(surplus)) < 3.0


def test_a_search_begins_with_a_sketch_of_each_piece_of_some_elements():
    ladder = Ladder(problem_of_discs(2), KINDS, 1.0, 1.0)
    ladder.on[:, 6:8] = ladder.on[12:] = False
    ladder.on[14, 14] = True
    points = ladder.beginnings(6)
    assert len(points) == 2
    assert np.hypot(*(points[points[:, 0].argsort()] - DISCS)[:, :2].T).max() < 1.0


@pytest.mark.slow  # plain code takes some seconds
def test_a_ladder_has_two_sketches_where_two_discs_lie_and_they_are_the_likeliest():
    ladder = Ladder(problem_of_discs(2), KINDS, 1.0, 1.0)
    every = ladder.ladder(ladder.together(ladder.sketch_of(ladder.on), 0), 3)
    assert [its.rank for its in every] == sorted((its.rank for its in every), reverse=True)
    best = {len(its.points): its for its in reversed(every)}
    assert {1, 2} <= set(best)
    assert max(best, key=lambda n: best[n].rank) == 2
    two = best[2].points
    two = two[two[:, 0].argsort()]
    assert np.hypot(*(two - DISCS)[:, :2].T).max() < 0.5


def test_neighbours_are_those_next_to_each_other_and_what_explains_least_comes_first():
    own = np.full((6, 12), -1)
    own[1:4, 0:3], own[1:4, 3:6], own[1:4, 7:9] = 0, 1, 2
    unexplained = np.zeros(own.shape)
    unexplained[2, 8] = 5.0
    first, second = neighbours(own, unexplained, 3)
    assert first[0] == (2, 1)
    assert second[0] == (1, 0)
    assert first[2] == 5.0
    assert (second[1] == ((own == 0) | (own == 1))).all()
    own[1:4, 3:6] = -1
    assert neighbours(own, unexplained, 3) == []


def test_a_mask_is_dilated_over_corners():
    mask = np.zeros((4, 4), bool)
    mask[0, 0] = True
    assert dilated(mask).sum() == 4
