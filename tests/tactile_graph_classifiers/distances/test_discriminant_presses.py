"""The last few presses named together, as they come."""

from __future__ import annotations

import math

import pytest

from helpers_classifiers import export_of, reading, three_objects
from tactile_graph.errors import DataError
from tactile_graph_classifiers.distances.discriminant import CanonicalDiscriminant
from tactile_graph_classifiers.distances.discriminant_presses import DiscriminantOfPresses

pytestmark = pytest.mark.slow
PRESSES = [reading(505, 41), reading(493, 37), reading(508, 44), reading(498, 40)]


def test_each_press_is_named_with_those_before_it():
    database = export_of(three_objects())
    step = DiscriminantOfPresses(database=database, presses=3)
    wanted = CanonicalDiscriminant(database=database)
    found = [step(press) for press in PRESSES]
    assert [it.n_presses for it in found] == [1, 2, 3, 3]
    assert found[2] == wanted.together(PRESSES[:3])
    assert found[3] == wanted.together(PRESSES[1:])
    assert found[3].name == "light"


def test_after_a_long_gap_another_object_may_lie_there():
    step = DiscriminantOfPresses(database=export_of(three_objects()), start_anew_s=2.0)
    assert [step(press, gap_s=1.0).n_presses for press in PRESSES[:3]] == [1, 2, 3]
    for gap_s in (5.0, -3.0):  # where the clock goes back, too
        found = step(reading(1990, 38), gap_s=gap_s)
        assert (found.name, found.n_presses) == ("heavy", 1)


def test_a_reading_that_cannot_be_named_is_not_kept():
    step = DiscriminantOfPresses(database=export_of(three_objects()))
    step(PRESSES[0])
    with pytest.raises(DataError, match="'area_cm2' must be a finite number"):
        step(reading(500.0, math.nan))
    assert step(PRESSES[1]).n_presses == 2
