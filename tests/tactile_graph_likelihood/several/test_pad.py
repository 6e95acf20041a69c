"""Parts of a pad that nothing connects, and how many outlines all of them have together."""

import math

import numpy as np
import pytest

from tactile_graph.wires import Circle, Rectangle
from tactile_graph_likelihood.geometry.outlines import DISC, ELLIPSE, RECTANGLE
from tactile_graph_likelihood.several.pad import Expected, chosen, parts_of, split
from tactile_graph_likelihood.single.density.element_terms import OFF, ON, OVER, UNKNOWN
from tactile_graph_likelihood.single.noise import Noise
from tactile_graph_likelihood.single.readings import Readings

GRID = np.array([0.0, 0.0, 1.3, 1.0, 0.0, 0.0])
EXPECTED = Expected([(DISC, 0), (RECTANGLE, 0)], (1.0, 12.0), 1.0, 6, 3.0)


def problem_of_two(*extra):
    states = np.zeros((16, 16), np.uint8)
    states[2:5, 2:5] = ON
    states[7:10, 4:8] = ON
    for place in extra:
        states[place] = ON
    logs = np.where(states == ON, 4.0, 0.0)
    return EXPECTED.problem(Readings(GRID, logs, states, 21), Noise().vector(1.3))


def test_parts_are_cropped_where_they_lie_and_do_not_see_each_other():
    one, other = parts_of(problem_of_two(), EXPECTED, 1.0)
    assert one.problem.states.shape == (7, 7)
    assert other.problem.states.shape == (7, 8)
    assert one.problem.grid[:2] == pytest.approx([0.0, 0.0])
    assert other.problem.grid[:2] == pytest.approx([2 * 1.3, 5 * 1.3])
    assert (one.problem.states == ON).sum() == 9
    assert (other.problem.states == ON).sum() == 12
    assert not (one.problem.states == UNKNOWN).any()


def test_what_touches_within_the_margin_belongs_to_another_part_and_is_unknown():
    lonely = 7, 2  # a stray, too small to be a part, two cells from nothing of the first
    first, *_ = parts_of(problem_of_two(lonely), EXPECTED, 1.0)
    assert (first.problem.states == ON).sum() == 9
    assert set(np.unique(first.problem.states)) <= {OFF, ON, UNKNOWN}


def test_a_reading_at_its_end_counts_as_a_load():
    states = np.zeros((4, 4), np.uint8)
    states[1, 1], states[2, 2] = ON, OVER
    problem = EXPECTED.problem(Readings(GRID, np.ones((4, 4)), states, 2), Noise().vector(1.3))
    assert (problem.states == ON).sum() == 2


def test_numbers_of_all_parts_together_are_weighed_with_their_orders():
    logs, choice = chosen([{1: 10.0, 2: 9.8}, {1: 5.0}], 6)
    assert choice[2] == (1, 1)
    assert choice[3] == (2, 1)
    assert logs[2] == pytest.approx(15.0 + math.log(2.0))
    assert logs[3] == pytest.approx(14.8 + math.log(6.0))


def test_no_more_than_allowed_are_chosen_and_the_least_likely_go():
    logs, choice = chosen([{1: 10.0}, {1: 5.0}, {1: 7.0}], 2)
    assert max(logs) == 2
    assert choice[2] == (1, 0, 1)


def test_shapes_of_other_kinds_become_what_is_looked_for_and_go_to_the_nearest_part():
    problem = problem_of_two()
    expected = Expected([(DISC, 0), (ELLIPSE, 0)], (1.0, 12.0), 1.0, 6, 3.0)
    begin = expected.outlines([Circle(4.0, 4.0, 2.0), Rectangle(7.0, 11.0, 5.0, 4.0, 0.0)], problem)
    assert begin.kinds.tolist() == [DISC, ELLIPSE]
    assert math.pi * begin.points[1, 2] * begin.points[1, 3] == pytest.approx(20.0)
    one, other = split(begin, parts_of(problem, expected, 1.0))
    assert one.kinds.tolist() == [DISC]
    assert other.kinds.tolist() == [ELLIPSE]
    assert split(begin.only(0), parts_of(problem, expected, 1.0))[1] is None
