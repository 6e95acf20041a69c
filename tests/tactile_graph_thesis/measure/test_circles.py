"""Errors of circles against the truth."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np

from tactile_graph import Circle, Frame
from tactile_graph.wires import TrueObject
from tactile_graph_thesis.measure.circles import circle_errors, signed_circle_errors


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
