"""What reliefs cannot be learned of is said before anything is learned."""

from __future__ import annotations

import numpy as np
import pytest

from helpers_classifiers import lesson
from helpers_reliefs import as_presses
from tactile_graph import Image
from tactile_graph.errors import DataError
from tactile_graph_classifiers.database.known import Known, KnownObject
from tactile_graph_classifiers.database.relief_rows import Press
from tactile_graph_classifiers.database.statistics import Statistics
from tactile_graph_classifiers.measuring.reader import _press
from tactile_graph_classifiers.reliefs.choosing_law import _next, _objects
from tactile_graph_classifiers.reliefs.of_database import FEWEST, learned_of
from tactile_graph_classifiers.reliefs.pad_reading import LEAST, MOST, Law


def known(*names: str) -> Known:
    objects = []
    for name in names:
        rows = lesson(name, *[(500.0, 40.0)] * FEWEST).readings
        objects.append(KnownObject(name, "", rows, Statistics.of(rows)))
    return Known("objects.sqlite", ("weight", "area_cm2"), "raw", tuple(objects))


def pressed(value: float = 5.0, shape=(6, 8), pitch_cm: float = 0.5) -> Press:
    values = np.zeros(shape)
    values[2:4, 2:4] = value
    return Press(values, pitch_cm)


def say(_: str) -> None:
    raise AssertionError("nothing is to be learned")


def test_an_object_with_too_few_presses_is_named():
    images = [[pressed()] * FEWEST, [pressed()] * (FEWEST - 1) + [None]]
    with pytest.raises(DataError, match=r"ball: fewer than 8 presses .* learn with --keep-presses"):
        learned_of(known("cup", "ball"), images, say)


@pytest.mark.parametrize("other", [pressed(shape=(8, 8)), pressed(pitch_cm=0.6)])
def test_presses_on_several_pads_are_refused(other):
    images = [[pressed()] * FEWEST, [pressed()] * (FEWEST - 1) + [other]]
    with pytest.raises(DataError, match=r"presses are on several pads: 6 x 8 cells of 0.5 cm and"):
        learned_of(known("cup", "ball"), images, say)


def test_a_press_in_which_nothing_touches_is_told_with_its_object():
    images = [[pressed()] * FEWEST, [pressed(0.0)] * FEWEST]
    with pytest.raises(DataError, match="'ball': in a press nothing reads more than"):
        learned_of(known("cup", "ball"), images, say)


def test_cells_that_are_not_square_are_refused_and_broken_ones_are_none():
    valid = np.ones((2, 2), dtype=bool)
    valid[0, 1] = False
    press = _press(Image(np.ones((2, 2)), (0.5, 0.5), valid=valid))
    assert press.pitch_cm == 0.5
    assert np.isnan(press.values).tolist() == [[False, True], [False, False]]
    with pytest.raises(DataError, match=r"learned on square cells, and these are 0.5 x 0.6 cm"):
        _press(Image(np.ones((2, 2)), (0.5, 0.6)))
    with pytest.raises(DataError, match="what is measured is no image"):
        _press(7)


def test_steps_of_the_law_stay_within_bounds():
    assert _next(Law(0.5, 1.0, 0.01), 0, 1.5, True) == Law(0.75, 1.0, 0.01)
    assert _next(Law(0.5, 1.0, 0.01), 1, 0.1, False) == Law(0.5, 0.9, 0.01)
    assert _next(Law(MOST[0], 1.0, 0.01), 0, 1.5, True) is None
    assert _next(Law(0.5, LEAST[1], 0.01), 1, 0.1, False) is None


@pytest.mark.parametrize("n", [1, 2, 6, 7, 22])
def test_the_law_is_chosen_by_up_to_six_objects_but_the_largest(n):
    sizes = np.random.default_rng(n).permutation(n) + 1
    all_presses = [as_presses(np.zeros((1, 9, 40)), [[0, 0, 1, size]], [[0, 0]]) for size in sizes]
    chosen = list(_objects(all_presses))
    assert len(chosen) == min(n, 6)
    if n > 10:
        assert sizes[chosen].max() < n
