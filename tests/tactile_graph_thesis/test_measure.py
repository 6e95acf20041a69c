"""Spreads, running variances and errors against the truth."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from tactile_graph import Circle, Frame
from tactile_graph.wires import TrueObject
from tactile_graph_thesis.measure.circles import (
    circle_errors,
    grouped,
    max_and_average,
    signed_circle_errors,
)
from tactile_graph_thesis.measure.spread import spread
from tactile_graph_thesis.measure.thresholds import running_variances


def frame(name: str, circle: Circle) -> Frame:
    return Frame.of(np.zeros((2, 2)), truth=(TrueObject(circle, 100.0, name),))


def runner(circle: Circle | None) -> object:
    return lambda _: SimpleNamespace(get=lambda name: circle if name == "circle" else None)


def test_circle_errors_are_sorted_by_object_and_signed() -> None:
    frames = [frame("b", Circle(5, 5, 2)), frame("a", Circle(1, 2, 3)), frame("b", Circle(6, 6, 2))]
    frames.append(frame("a", Circle(2, 2, 3)))
    found = signed_circle_errors(frames, [runner(Circle(4, 4, 4))], ["a", "b"])
    assert found.shape == (1, 2, 2, 3)
    assert found[0, 0].tolist() == [[3, 2, 1], [2, 2, 1]]
    assert found[0, 1].tolist() == [[-1, -1, 2], [-2, -2, 2]]
    assert (circle_errors(frames, [runner(Circle(4, 4, 4))], ["a", "b"]) == abs(found)).all()


def test_no_answer_counts_as_the_object_s_radius() -> None:
    found = circle_errors([frame("a", Circle(1, 2, 3))], [runner(None)], ["a"])
    assert found.ravel().tolist() == [3, 3, 3]


def test_maximum_is_the_mean_over_groups_of_each_group_s() -> None:
    errors = np.zeros((7, 3))
    errors[:, 0] = [1, 5, 2, 2, 9, 1, 100]
    table = max_and_average(errors, 3)
    assert table[0] == (5 + 9) / 2  # the seventh is left over
    assert table[1] == pytest.approx(errors[:, 0].mean())
    assert grouped(errors, 3).shape == (2, 3, 3)


def test_a_spread_leaves_out_readings_without_an_answer_and_counts_them() -> None:
    errors = np.array([1.0, 3.0, np.nan, 2.0, 4.0, 0.0, 9.0])
    found = spread(errors, 2)
    assert found.missing == 1
    assert found.average == pytest.approx(19 / 6)
    assert found.largest == pytest.approx((3 + 4 + 9) / 3)
    assert found.average_range[0] == pytest.approx(2.1)
    assert found.average_range[1] == pytest.approx(4.35)


def test_a_spread_of_nothing_is_no_number() -> None:
    found = spread(np.full(4, np.nan), 2)
    assert found.missing == 4
    assert np.isnan(found.average)


def test_running_variances_are_those_of_the_first_readings() -> None:
    errors = np.random.default_rng(0).normal(size=(2, 23))
    found = running_variances(errors, 10)
    assert found.shape == (2, 2, 9)
    for k in range(2, 11):
        expected = errors[1, 10 : 10 + k].var(ddof=1)
        assert found[1, 1, k - 2] == pytest.approx(expected)
