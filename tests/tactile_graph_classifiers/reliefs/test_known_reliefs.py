"""Reliefs come back from the arrays that a database keeps; numbers that cannot be are refused."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from helpers_reliefs import bowl, even_pad, relief
from tactile_graph.errors import DataError
from tactile_graph_classifiers.reliefs.known_reliefs import KnownReliefs


def known() -> KnownReliefs:
    reliefs = [relief(bowl(n), np.zeros((2, 6)), np.ones(2)) for n in (21, 31)]
    left_out = [np.array([10.0, 20.0, 30.0]), np.array([np.nan, 900.0, 1100.0])]
    return KnownReliefs.of(even_pad(), (255.0, 0.5), ("cup", "ball"), reliefs, left_out)


def test_they_come_back_as_they_were():
    made = known()
    back = KnownReliefs.from_kept(made.kept(), "here")
    assert (back.names, back.full_scale, back.pitch_cm) == (made.names, 255.0, 0.5)
    assert back.pad.law == made.pad.law
    np.testing.assert_array_equal(back.pad.gains, made.pad.gains)
    np.testing.assert_array_equal(back.usual, made.usual)
    for a, b in zip(back.reliefs, made.reliefs, strict=True):
        np.testing.assert_array_equal(a.depth, b.depth)
        assert (a.usual, a.soft) == (b.usual, b.soft)


def test_an_object_s_usual_misfit_is_held_near_that_of_all():
    assert known().usual.tolist() == [255.0, 1000.0]  # of 20 and 1000; that of all is 510


def test_an_object_that_was_not_learned_is_named():
    reliefs = [relief(bowl(21), np.zeros((2, 6)), np.ones(2)) for _ in range(3)]
    left_out = [np.full(4, value) for value in (100.0, 120.0, 900.0)]
    names = ("cup", "ball", "comb")
    found = KnownReliefs.of(even_pad(), (255.0, 0.5), names, reliefs, left_out)
    assert found.badly_learned() == ["comb"]
    nothing = [np.full(4, np.nan)] * 3
    assert KnownReliefs.of(even_pad(), (255.0, 0.5), names, reliefs, nothing).badly_learned() == []


def test_readings_that_vary_beside_the_reliefs_are_told():
    made = known()
    assert made.explained_poorly() == 0.0
    pad = replace(made.pad, variances=np.array([1e-6, 0.4**2, 1e-4]))
    assert replace(made, pad=pad).explained_poorly() == pytest.approx(0.4)


@pytest.mark.parametrize(
    ("array", "value"), [("law", [[9.0, 1.0, 0.01]]), ("variances", [[0.0, 1.0, 1.0]]),
                         ("numbers", [[-1.0, 1.0, 1.0, 1.0]])],
)  # fmt: skip
def test_numbers_that_cannot_be_are_refused(array, value):
    kept = known().kept()
    kept.pad[array] = np.array(value)
    with pytest.raises(DataError, match="out of range"):
        KnownReliefs.from_kept(kept, "here")
