"""Objects that press with their rim alone."""

import math

import numpy as np
import pytest

from tactile_graph_likelihood.any_pad.pad_effects.hollow import is_covered_rim, without_hollow
from tactile_graph_likelihood.geometry.outlines import DISC, ELLIPSE, RECTANGLE
from tactile_graph_likelihood.single.density.element_terms import ON, UNDER, UNKNOWN
from tactile_graph_likelihood.single.readings import Readings

GRID = np.array([0.0, 0.0, 1.3, 1.0, 0.0, 0.0])
MIDDLE = 0.5 + 1.3 * np.arange(16)
FAR = np.hypot(MIDDLE - 10.0, MIDDLE[:, None] - 10.0)
HALF_EMPTY = 0.0
"""Log odds of a void."""


def readings_of(shown: np.ndarray) -> Readings:
    states = np.where(shown, np.uint8(ON), np.uint8(UNDER))
    return Readings(GRID, np.zeros(shown.shape), states, int(shown.sum()))


RING = readings_of((FAR < 7.0) & (FAR > 4.2))


@pytest.mark.parametrize(
    ("kind", "p"), [(DISC, [10.0, 10.0, 7.0]), (ELLIPSE, [10.0, 10.0, 7.0, 7.0, 0.3])]
)
def test_what_lies_in_a_ring_is_unknown(kind: int, p: list[float]) -> None:
    found = without_hollow(kind, RING, np.array(p), HALF_EMPTY)
    assert found is not None
    assert (found.states[FAR < 4.0] == UNKNOWN).all()
    np.testing.assert_array_equal(found.states[FAR > 5.5], RING.states[FAR > 5.5])
    assert found.touched == (found.states == ON).sum() <= RING.touched


def test_so_is_what_lies_in_a_frame() -> None:
    x, y = MIDDLE - 10.0, MIDDLE[:, None] - 10.0
    cos, sin = math.cos(0.4), math.sin(0.4)
    u, v = np.abs(x * cos - y * sin) / 8.0, np.abs(x * sin + y * cos) / 6.0
    r = np.maximum(u, v)
    frame = readings_of((r < 1.0) & (r > 0.6))
    found = without_hollow(RECTANGLE, frame, np.array([10.0, 10.0, 8.0, 6.0, 0.4]), HALF_EMPTY)
    assert found is not None
    assert (found.states[r < 0.6] == UNKNOWN).all()
    np.testing.assert_array_equal(found.states[r > 0.8], frame.states[r > 0.8])


def test_voids_all_over_are_no_hollow() -> None:
    disc = np.array([10.0, 10.0, 7.0])
    for seed in range(200):
        rng = np.random.default_rng(seed)
        found = readings_of((FAR < 7.0) & (rng.random(FAR.shape) > 0.4))
        assert without_hollow(DISC, found, disc, HALF_EMPTY) is None


def test_few_voids_are_not_looked_into_and_small_outlines_say_nothing() -> None:
    assert without_hollow(DISC, RING, np.array([10.0, 10.0, 7.0]), -2.0) is None
    assert without_hollow(DISC, RING, np.array([10.0, 10.0, 2.0]), HALF_EMPTY) is None


RIM = (FAR < 7.0) & (FAR > 5.5)
"""A bottle's: about an element wide."""


def loads_of(loads: np.ndarray) -> Readings:
    shown = loads > 0.0
    states = np.where(shown, np.uint8(ON), np.uint8(UNDER))
    return Readings(GRID, np.log(np.where(shown, loads, 1.0)), states, int(shown.sum()))


@pytest.mark.parametrize("kind", [DISC, ELLIPSE])
def test_a_middle_that_reads_far_less_is_a_rim_under_a_cover(kind: int) -> None:
    p = np.array([10.0, 10.0, 7.2] if kind == DISC else [10.0, 10.0, 7.2, 7.2, 0.3])
    loads = np.where(RIM, 100.0, np.where(FAR < 8.5, 10.0, 0.0))
    assert is_covered_rim(kind, loads_of(loads), p)
    assert not is_covered_rim(kind, loads_of(np.where(RIM, 100.0, 0.0)), p)
    undone = loads_of(np.where(RIM, 100.0, 0.0))._replace(through_foam=loads_of(loads))
    assert is_covered_rim(kind, undone, p)


def test_uneven_elements_and_small_outlines_are_no_such_rim() -> None:
    for seed in range(100):
        gains = np.exp(0.7 * np.random.default_rng(seed).standard_normal(FAR.shape))
        found = loads_of(np.where(FAR < 7.0, 100.0 * gains, 0.0))
        assert not is_covered_rim(DISC, found, np.array([10.0, 10.0, 7.0]))
    small = loads_of(np.where(FAR < 2.0, 100.0 - 90.0 * (FAR < 1.0), 0.0))
    assert not is_covered_rim(DISC, small, np.array([10.0, 10.0, 2.0]))
