"""Slopes of coverage: those of its differences, at any place, and none where nothing moves."""

import numpy as np
import pytest

from tactile_graph_likelihood.geometry.covered import covered, window
from tactile_graph_likelihood.geometry.outlines import DISC, ELLIPSE, OVAL, RECTANGLE
from tactile_graph_likelihood.geometry.rim_slopes import covered_with_slopes

PITCH_CM, ELEMENT_CM = 1.3, 1.0


def grid_of(soft):
    return np.array([0.0, 0.0, PITCH_CM, ELEMENT_CM, soft, PITCH_CM if soft else 0.0])


def found_and_differenced(kind, p, soft, step=1e-6):
    """Return slopes and differences of coverage, shape (K, rows, columns) each."""
    grid, numbers = grid_of(soft), np.array(p, dtype=np.float64)
    box = window(kind, 0, numbers, grid, 16, 16, 3.0)
    slopes, differences = np.zeros((len(p), box[2], box[3])), []
    shares = covered_with_slopes(kind, numbers, grid, box, slopes)
    assert np.allclose(shares, covered(kind, 0, numbers, grid, box))
    for k in range(len(p)):
        move = step * np.eye(len(p))[k]
        more, less = (covered(kind, 0, numbers + way * move, grid, box) for way in (1.0, -1.0))
        differences.append((more - less) / (2.0 * step))
    return slopes, np.array(differences)


@pytest.mark.slow
@pytest.mark.parametrize("soft", [0.0, 0.05])
@pytest.mark.parametrize("kind", [DISC, RECTANGLE, OVAL, ELLIPSE])
def test_slopes_are_those_of_differences(kind, soft):
    rng = np.random.default_rng(5)
    for _ in range(30):
        p = [*rng.uniform(4.0, 15.0, 2), rng.uniform(0.7, 6.0)]
        if kind in (RECTANGLE, ELLIPSE):
            p += [rng.uniform(0.7, 6.0), rng.uniform(-2.0, 2.0)]
        if kind == OVAL:
            p += [*(0.6 * p[2] * rng.uniform(-1.0, 1.0, 2))]
        slopes, differences = found_and_differenced(kind, p, soft)
        assert slopes == pytest.approx(differences, abs=1e-5)


def test_a_disc_within_an_element_only_grows_on_it():
    middle = 3.0 * PITCH_CM + 0.5 * ELEMENT_CM
    slopes, _ = found_and_differenced(DISC, (middle, middle, 0.4), 0.0)
    assert slopes[:2] == pytest.approx(0.0, abs=1e-12)
    assert slopes[2].sum() == pytest.approx(2.0 * np.pi * 0.4 / ELEMENT_CM**2)


def test_an_upright_rectangles_side_in_a_gap_moves_nothing():
    left = 2.0 * PITCH_CM - 0.15  # in the middle of a gap
    p = (left + 2.0, 8.0, 2.0, 2.3, 0.0)
    slopes, _ = found_and_differenced(RECTANGLE, p, 0.0)
    assert slopes[0, :, 0] == pytest.approx(0.0)
