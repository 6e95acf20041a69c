"""How loads grow with what the pressure is told by, beside differences of the loads themselves."""

import math

import numpy as np
import pytest

from helpers_likelihood import GRID
from helpers_modes import plainly
from tactile_graph_likelihood.geometry.outlines import DISC, ELLIPSE, OVAL, RECTANGLE
from tactile_graph_likelihood.single.density.element_terms import (
    CONTRAST,
    FALL,
    FOAM,
    LEAN_X,
    LEAN_Y,
    SIGMA,
    STRAYS,
)
from tactile_graph_likelihood.single.density.information import shares_with_slopes
from tactile_graph_likelihood.single.density.load_shares import mean_pressure, shares_of
from tactile_graph_likelihood.single.density.pressure_slopes import Laid, mean_pressure_with_slopes

pytestmark = pytest.mark.usefixtures("warm_kernels")

SHAPE = (16, 16)
BOX = (0, 0, *SHAPE)
STEP = 2e-3  # a quarter of what coverage is differenced over
OUTLINES = {
    "disc": (DISC, [10.42, 9.58, 4.17]),
    "oval": (OVAL, [10.42, 9.58, 4.17, 0.5, 0.3]),
    "ellipse": (ELLIPSE, [10.42, 9.58, 4.17, 2.5, 0.3]),
    "rectangle": (RECTANGLE, [10.42, 9.58, 4.17, 2.5, 0.4]),
}
PRESSURES = {
    "even": {FALL: 0.0},
    "round": {FALL: 0.5},
    "a rim": {FALL: -0.4},
    "leaning": {LEAN_X: 0.3, LEAN_Y: -0.5},
    "round, leaning, on foam": {FALL: 0.7, LEAN_X: -0.2, LEAN_Y: 0.1, FOAM: 0.6},
}


def noise_of(pressure):
    """Return a noise vector of a pressure."""
    noise = np.zeros(CONTRAST + 1)
    noise[SIGMA], noise[STRAYS], noise[CONTRAST] = 0.5, 1e-3, 1.0
    for place, value in pressure.items():
        noise[place] = value
    return noise


def shares_at(kind, p, noise):
    return shares_of.compiled(kind, 0, p, GRID, noise, BOX, *SHAPE)


def slope_along(kind, p, noise, values, place):
    """Return how shares grow with one of an outline's or of the noise's numbers."""
    found = []
    for off in (STEP, -STEP):
        values[place] += off
        found.append(shares_at(kind, p, noise))
        values[place] -= off
    return (found[0] - found[1]) / (2.0 * STEP)


@pytest.mark.slow  # much is compiled
@pytest.mark.parametrize("pressure", PRESSURES)
@pytest.mark.parametrize("outline", OUTLINES)
def test_loads_grow_as_they_are_said_to(outline: str, pressure: str) -> None:
    kind, numbers = OUTLINES[outline]
    p, noise = np.array([*numbers, math.log(60.0)]), noise_of(PRESSURES[pressure])
    places = np.array([k for k in PRESSURES[pressure] if k != FOAM])
    rise = np.zeros((len(p) + len(places), *SHAPE))
    laid = Laid(kind, 0, p, GRID, noise, BOX)
    share, _ = shares_with_slopes.compiled(laid, *SHAPE, places, rise)
    np.testing.assert_allclose(share, shares_at(kind, p, noise), atol=1e-12)
    slopes = [slope_along(kind, p, noise, p, k) for k in range(len(numbers))]
    # Past a rectangle's diagonal another side is nearer, and a rim's own slope is endless.
    few = 4 if pressure == "a rim" else 0
    for k, true in enumerate(slopes):
        off = np.sort(abs(rise[k] - true), axis=None)[: share.size - few]
        assert off.sum() < max(0.015 * abs(true).sum(), 1e-9)
    for k, place in enumerate(places, len(p)):
        true = slope_along(kind, p, noise, noise, place)
        assert abs(rise[k] - true).sum() < 1e-4 * abs(true).sum()


def test_beyond_what_a_face_may_fall_nothing_grows() -> None:
    p, rise = np.array([10.3, 9.7, 4.1, 4.0]), np.zeros((5, *SHAPE))
    noise = noise_of({FALL: 9.0})
    laid = Laid(DISC, 0, p, GRID, noise, BOX)
    plainly(shares_with_slopes)(laid, *SHAPE, np.array([FALL]), rise)
    assert rise[2].any()
    assert not rise[4].any()


def test_a_mean_pressure_grows_as_it_is_said_to() -> None:
    rng = np.random.default_rng(0)
    mean_of, told = plainly(mean_pressure), plainly(mean_pressure_with_slopes)
    for _ in range(2000):
        at = rng.uniform([0.0, 0.02, -0.6], [1.15, 0.4, 2.5])
        mean, *slopes = told(*at)
        assert mean == pytest.approx(mean_of(*at), rel=1e-12)
        if at[2] < 0.0 and 0.0 < 1.0 - (at[0] + at[1]) ** 2 < 0.021:
            continue  # the rim's own slope, which is endless, is told as a little within it
        for k, slope in enumerate(slopes):
            off = 1e-6 * np.eye(3)[k]
            true = (mean_of(*(at + off)) - mean_of(*(at - off))) / 2e-6
            assert slope == pytest.approx(true, rel=1e-3, abs=1e-3)
