"""Tables 4.7 and 4.8: what is counted, and how it stands beside the thesis."""

import math
from dataclasses import replace

import numpy as np
import pytest

from tactile_graph import load
from tactile_graph_thesis.measure.rectangles import (
    OBJECTS,
    STATED_CELL_CM,
    THESIS,
    beside_thesis,
    rectangle_frames,
    signed_errors,
    table_4_7,
    table_4_8,
)


class Answer:
    """A result with one rectangle, none, or one beside an axis."""

    def __init__(self, rectangle, axis=None):
        self._nodes = {"rectangle": rectangle} | ({"axis": axis} if axis else {})

    def get(self, name):
        return self._nodes[name]

    def __getitem__(self, name):
        return self._nodes[name]

    def __contains__(self, name):
        return name in self._nodes


def moved(shape, **by):
    return replace(shape, **{key: getattr(shape, key) + more for key, more in by.items()})


@pytest.fixture(scope="module")
def frames():
    return rectangle_frames(3, seed=4, sigma=0.0, voids=0.0)


def test_both_rectangles_of_table_4_6_come_in_turn(frames):
    sides = {(f.truth[0].name, f.truth[0].shape.length_cm, f.truth[0].shape.breadth_cm)
             for f in frames}  # fmt: skip
    assert sides == {("RECTANGLE I", 16.0, 7.0), ("RECTANGLE II", 14.0, 3.0)}
    assert len(frames) == 6


def test_errors_are_what_is_found_less_what_is_true(frames):
    found = signed_errors(
        lambda f: Answer(moved(f.truth[0].shape, x_cm=0.3, y_cm=0.4, length_cm=-1.0,
                               breadth_cm=0.5, angle_rad=math.pi + 0.02)),
        frames,
    )  # fmt: skip
    for name in OBJECTS:
        expected = [math.degrees(0.02), -1.0, 0.5, 0.5]
        assert found[name] == pytest.approx(np.tile(expected, (3, 1)), abs=1e-9)


def test_the_angle_is_the_axis_where_there_is_one(frames):
    found = signed_errors(
        lambda f: Answer(f.truth[0].shape, moved(f.truth[0].shape, angle_rad=-0.1)), frames
    )
    assert found["RECTANGLE I"][:, 0] == pytest.approx(math.degrees(-0.1))


def test_cells_may_be_read_as_1_cm(frames):
    found = signed_errors(lambda f: Answer(f.truth[0].shape), frames, STATED_CELL_CM)
    assert found["RECTANGLE I"][:, 1] == pytest.approx(16.0 / 1.3 - 16.0)
    assert found["RECTANGLE II"][:, 2] == pytest.approx(3.0 / 1.3 - 3.0)


def test_readings_without_an_answer_are_left_out_and_counted(frames):
    good = iter([True, True, False, True, True, True])
    errors = signed_errors(lambda f: Answer(f.truth[0].shape if next(good) else None), frames)
    table = beside_thesis("rectangle-1", errors)
    assert table.missing == {"RECTANGLE I": 1, "RECTANGLE II": 0}
    assert table.n == 3
    assert [row.ours for row in table.rows] == pytest.approx([0.0] * 12, abs=1e-9)


def test_the_maximum_is_that_of_groups_of_twenty_on_average():
    errors = {name: np.zeros((40, 4)) for name in OBJECTS}
    errors["RECTANGLE II"][3, 1], errors["RECTANGLE II"][30, 1] = -4.0, 2.0
    rows = {(r.object, r.quantity, r.statistic): r
            for r in beside_thesis("rectangle-2", errors).rows}  # fmt: skip
    assert rows["RECTANGLE II", "length", "maximum"].ours == pytest.approx(3.0)
    assert rows["RECTANGLE II", "length", "average"].ours == pytest.approx(6.0 / 40)
    assert rows["RECTANGLE II", "length", "maximum"].ratio == pytest.approx(3.0 / 3.3)
    assert rows["RECTANGLE I", "length", "maximum"].ours == 0.0


def test_both_tables_are_equal_in_the_angle_and_hold_the_thesis_numbers():
    first, second = table_4_7(10, seed=3), table_4_8(10, seed=3)
    assert second.missing == {"RECTANGLE I": 0, "RECTANGLE II": 0}
    for one, other in zip(first.rows, second.rows, strict=True):
        assert one[:4] == other[:4]
        assert (one.ours == other.ours) == (one.quantity == "angle")
    assert [r.thesis for r in second.rows[6:]] == [9.0, 4.8, 3.3, 1.6, 1.6, 1.3]
    assert set(THESIS) == {"rectangle-1", "rectangle-2"}


def test_on_an_even_pad_rectangle_2_errs_by_the_ellipse_of_the_exact_outline(frames):
    """Full axes are 13 % and 20 % longer than the sides of RECTANGLE I: + 2.1 and + 1.4 cm."""
    even = rectangle_frames(60, seed=5, sigma=0.0, voids=0.0)
    found = signed_errors(load("rectangle-2").runner(), even)["RECTANGLE I"].mean(axis=0)
    assert found[1:3] == pytest.approx([2.1, 1.4], abs=0.3)
