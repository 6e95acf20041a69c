"""Two discs that touch, taken for one long outline."""

import math

import numpy as np
import pytest

from helpers_modes import plainly
from tactile_graph.wires import Image
from tactile_graph_likelihood.any_pad.choose import Locate
from tactile_graph_likelihood.any_pad.fits.waist import gain_by_two
from tactile_graph_likelihood.any_pad.locate import LocateEllipse, LocateRectangle
from tactile_graph_likelihood.geometry.outlines import ELLIPSE, RECTANGLE
from tactile_graph_likelihood.single.changed import changed
from tactile_graph_likelihood.single.density.element_terms import ON, UNDER
from tactile_graph_likelihood.single.density.problem import problem_of
from tactile_graph_likelihood.single.noise import Noise

FINE = (np.arange(320) + 0.5) / 20.0
RADIUS, TURN = 2.4, 0.4
ACROSS, DOWN = FINE - 8.0, FINE[:, None] - 8.0
ALONG = ACROSS * math.cos(TURN) - DOWN * math.sin(TURN)
ASIDE = ACROSS * math.sin(TURN) + DOWN * math.cos(TURN)
HALF, SHORT = 2.0 * RADIUS, 1.1 * RADIUS


def two(radius: float = RADIUS, other: float = RADIUS, load: float = 1.0) -> np.ndarray:
    """Return the pressure of two discs that touch in the middle."""
    first = np.hypot(ALONG + radius, ASIDE) < radius
    return first + load * (np.hypot(ALONG - other, ASIDE) < other)


ONE = {
    "ellipse": 1.0 * (np.hypot(ALONG / HALF, ASIDE / SHORT) < 1.0),
    "rectangle": 1.0 * ((np.abs(ALONG) < HALF) & (np.abs(ASIDE) < SHORT)),
    "ring": 1.0 * (np.abs(np.hypot(ALONG / HALF, ASIDE / SHORT) - 0.75) < 0.25),
}


def image_of(pressure: np.ndarray, seed: int = 1, uneven: float = 0.25) -> Image:
    rng = np.random.default_rng(seed)
    loads = 60.0 * pressure.reshape(16, 20, 16, 20).mean(axis=(1, 3))
    loads *= np.exp(uneven * rng.standard_normal(loads.shape)) * (rng.random(loads.shape) > 0.05)
    return Image(np.where(loads > 3.0, loads, 0.0), (1.0, 1.0), (0.0, 0.0), "gram")


def gain(kind: int, pressure: np.ndarray, *size: float, turn: float = TURN) -> float:
    values = image_of(pressure).values
    states = np.where(values > 0.0, np.uint8(ON), np.uint8(UNDER))
    logs = np.log(np.maximum(values, 3.0))
    grid = np.array([0.0, 0.0, 1.0, 1.0, 0.0, 0.0])
    p = np.array([8.0, 8.0, *size, turn, math.log(60.0)])
    noise = Noise(sigma=0.3, voids=0.1, least=3.0).vector(1.0)
    problem = problem_of(kind, 0, grid, logs, states, noise, np.zeros(9))
    return plainly(gain_by_two)(problem, p)


@pytest.mark.usefixtures("plain_kernels")
@pytest.mark.slow
@pytest.mark.parametrize("kind", [ELLIPSE, RECTANGLE])
def test_two_discs_are_likelier_where_there_are_two(kind: int) -> None:
    sizes = (HALF, 0.9 * RADIUS)
    assert gain(kind, two(), *sizes) > 8.0
    assert gain(kind, two(load=0.25), *sizes) > 8.0
    breadth_first = gain(kind, two(), *sizes[::-1], turn=TURN + 0.5 * math.pi)
    assert breadth_first == pytest.approx(gain(kind, two(), *sizes), abs=0.1)


@pytest.mark.usefixtures("plain_kernels")
@pytest.mark.slow
@pytest.mark.parametrize(("kind", "name"), [(ELLIPSE, "ellipse"), (RECTANGLE, "rectangle")])
def test_one_outline_is_likelier_where_there_is_one(kind: int, name: str) -> None:
    assert gain(kind, ONE[name], HALF, SHORT) < -5.0


@pytest.mark.usefixtures("plain_kernels")
def test_neither_round_nor_very_long_outlines_are_asked() -> None:
    assert gain(ELLIPSE, two(), 3.0, 2.5) == -math.inf
    assert gain(RECTANGLE, two(), 6.0, 1.5) == -math.inf


@pytest.mark.slow
@pytest.mark.usefixtures("warm_kernels")
@pytest.mark.parametrize("load", [1.0, 0.5, 0.25])
@pytest.mark.parametrize("other", [RADIUS, 0.8 * RADIUS])
def test_one_outline_over_two_discs_does_not_fit(load: float, other: float) -> None:
    found = [Locate()(image_of(two(RADIUS, other, load), seed)).shape for seed in range(8)]
    assert sum(not its.fits for its in found) >= 6
    flagged = next(its.posterior for its in found if not its.fits)
    assert flagged.in_parts
    assert changed(flagged, in_parts=False).fits, "nothing else tells it"


@pytest.mark.slow
@pytest.mark.usefixtures("warm_kernels")
@pytest.mark.parametrize("name", ONE)
def test_one_object_of_that_length_fits(name: str) -> None:
    step = LocateRectangle() if name == "rectangle" else LocateEllipse()
    for seed in range(8):
        assert not step(image_of(ONE[name], seed, 0.4)).posterior.in_parts
