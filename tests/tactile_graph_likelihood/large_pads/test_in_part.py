import numpy as np
import pytest

from tactile_graph_likelihood.geometry.outlines import DISC, ELLIPSE, RECTANGLE
from tactile_graph_likelihood.large_pads.in_part import PATCH, in_part
from tactile_graph_likelihood.single.density.element_terms import OFF, ON, UNKNOWN
from tactile_graph_likelihood.single.readings import Readings

N, PITCH_CM = 160, 0.5
GRID = np.array([0.0, 0.0, PITCH_CM, PITCH_CM, 0.0, 0.0])
MIDDLE_CM = (np.arange(N) + 0.5) * PITCH_CM

OUTLINES = {
    DISC: np.array([40.0, 41.0, 36.0, 0.0]),
    ELLIPSE: np.array([40.0, 41.0, 36.0, 25.0, 0.6, 0.0]),
    RECTANGLE: np.array([40.0, 41.0, 30.0, 20.0, 0.6, 0.0]),
}


def within(kind: int, p: np.ndarray, by_cm: float = 0.0) -> np.ndarray:
    """Return which elements' middles lie within an outline whose sizes are so much smaller."""
    a, b, turn = (p[2], p[2], 0.0) if kind == DISC else p[2:5]
    x, y = np.meshgrid(MIDDLE_CM - p[0], MIDDLE_CM - p[1])
    u = (x * np.cos(turn) - y * np.sin(turn)) / (a - by_cm)
    v = (x * np.sin(turn) + y * np.cos(turn)) / (b - by_cm)
    return np.maximum(abs(u), abs(v)) < 1.0 if kind == RECTANGLE else u * u + v * v < 1.0


@pytest.mark.parametrize("kind", OUTLINES)
def test_all_that_is_near_the_edge_or_beyond_it_is_kept(kind: int) -> None:
    p = OUTLINES[kind]
    states = np.where(within(kind, p), np.uint8(ON), np.uint8(OFF))
    readings = Readings(GRID, np.zeros((N, N)), states, int((states == ON).sum()))
    found = in_part(kind, readings, p)
    left_out = found.states == UNKNOWN
    assert found.part_of is readings
    assert found.is_wide
    assert found.touched == (found.states == ON).sum() < readings.touched / 2
    assert (found.states[~left_out] == states[~left_out]).all()
    assert not left_out[~within(kind, p, 2.9 * PITCH_CM)].any()


def test_patches_that_are_kept_lie_all_over_it() -> None:
    states = np.full((N, N), ON, np.uint8)
    found = in_part(DISC, Readings(GRID, np.zeros((N, N)), states, N * N), OUTLINES[DISC])
    kept = (found.states != UNKNOWN)[40:120, 40:120]
    row, column = kept.any(axis=1), kept.any(axis=0)
    assert (kept == row[:, None] & column).all()
    begins = np.flatnonzero(np.diff(row.astype(int)) == 1) + 1
    assert len(begins) >= 4
    assert all(row[k : k + PATCH].all() and not row[k + PATCH] for k in begins[:-1])
