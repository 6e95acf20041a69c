import math

import numpy as np
import pytest

from helpers_objects import Spot
from tactile_graph.errors import DataError, Degenerate
from tactile_graph.wires import Circle, Frame, Polygon, TrueObject
from tactile_graph_tracking.score_objects import score_objects

TRUTH = tuple(TrueObject(Circle(x, 5.0, 1.0)) for x in (2.0, 6.0, 10.0))


def frame(truth=TRUTH):
    return Frame.of(np.zeros((4, 4)), truth=truth)


def test_found_objects_pair_with_the_nearest_in_any_order():
    score = score_objects(frame(), [Spot(10.0, 5.5), Spot(2.0, 5.0), Spot(6.3, 5.4)])
    assert (score.n_true, score.n_found, score.n_paired) == (3, 3, 3)
    assert score.count_right
    assert score.mean_error_cm == pytest.approx(1.0 / 3)
    assert score.worst_error_cm == pytest.approx(0.5)
    assert [(i, j) for i, j, _ in score.pairs] == [(0, 1), (1, 2), (2, 0)]


def test_what_lies_beyond_the_gate_is_missed_and_extra():
    score = score_objects(frame(), [Spot(2.0, 5.0), Spot(6.0, 9.0)], gate_cm=2.0)
    assert (score.n_paired, score.n_missed, score.n_extra) == (1, 2, 1)
    assert not score.count_right


def test_as_many_pairs_as_possible_come_before_short_distances():
    """The middle one would be nearest to the first; then the last found would stay alone."""
    found = [Spot(4.0, 5.0), Spot(0.5, 5.0)]
    truth = (TrueObject(Circle(3.9, 5.0, 1.0)), TrueObject(Circle(5.8, 5.0, 1.0)))
    assert score_objects(frame(truth), found, gate_cm=2.0).n_paired == 1
    found = [Spot(4.0, 5.0), Spot(2.0, 5.0)]
    score = score_objects(frame(truth), found, gate_cm=2.0)
    assert [(i, j) for i, j, _ in score.pairs] == [(0, 1), (1, 0)]


def test_nothing_found_and_nothing_there_are_numbers_not_failures():
    assert score_objects(frame()) == (3, 0, False, 0, 3, 0, 0.0, 0.0, ())
    assert score_objects(frame(()), [Spot(1.0, 1.0)]) == (0, 1, False, 0, 0, 1, 0.0, 0.0, ())
    assert score_objects(frame(())).count_right


def test_shapes_of_all_kinds_can_be_found():
    square = Polygon(np.array([[5.0, 4.0], [7.0, 4.0], [7.0, 6.0], [5.0, 6.0]]))
    score = score_objects(frame(), [square, Circle(2.0, 5.0, 1.0), TRUTH[2].shape])
    assert score.worst_error_cm == pytest.approx(0.0)


def test_without_truth_it_says_so():
    with pytest.raises(Degenerate, match="the frame has no truth to score against"):
        score_objects(frame(None), [])


def test_what_has_no_centre_is_refused():
    with pytest.raises(DataError, match=r"item 2 must have x_cm and y_cm .* got a int"):
        score_objects(frame(), [Spot(1.0, 1.0), 3])
    with pytest.raises(DataError, match="item 1: its centre must be finite, got"):
        score_objects(frame(), [Spot(math.nan, 1.0)])
