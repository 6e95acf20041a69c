"""Priors are densities: they add up to one over all outlines."""

import math

import numpy as np
import pytest

from helpers_modes import compiled, plainly
from tactile_graph_likelihood.geometry.outline_prior import log_prior, pulled_in
from tactile_graph_likelihood.geometry.outlines import DISC, ELLIPSE, FREE, RECTANGLE, REGULAR

PAD = (1.0, 2.0, 20.0, 18.0)


def prior(whole, turn=0.3, smallest=0.5, largest=4.0):
    return np.array([*PAD, smallest, largest, whole, turn, 0.0])


@pytest.mark.slow
@pytest.mark.parametrize("whole", [0.0, 0.9, 1.0])
@pytest.mark.parametrize(
    ("kind", "corners", "sizes", "turns"),
    [(DISC, 0, 1, 0), (RECTANGLE, 0, 2, 1), (ELLIPSE, 0, 2, 1), (REGULAR, 5, 1, 1)],
)
def test_a_prior_adds_up_to_one(kind, corners, sizes, turns, whole):
    rng = np.random.default_rng(7)
    n = 40_000
    place = rng.uniform((-2, -1), (24, 23), (n, 2))
    lengths = rng.uniform(0.4, 4.2, (n, sizes))
    angle = rng.uniform(-1.2, 1.8, (n, turns))
    volume = 26.0 * 24.0 * 3.8**sizes * 3.0**turns
    points = np.hstack([place, lengths, angle])
    density = [math.exp(log_prior.compiled(kind, corners, p, prior(whole))) for p in points]
    assert volume * np.mean(density) == pytest.approx(1.0, abs=0.05)


@pytest.mark.slow  # much is compiled
def test_free_triangles_add_up_to_one():
    rng = np.random.default_rng(8)
    points = rng.uniform(0, 1, (40_000, 3, 2)) * PAD[2:] + PAD[:2]
    volume = (PAD[2] * PAD[3]) ** 3
    density = [math.exp(log_prior.compiled(FREE, 3, p.ravel(), prior(1.0))) for p in points]
    # each of a triangle's labellings in the right sense counts: 3 of 6
    assert volume * np.mean(density) / 3.0 == pytest.approx(1.0, abs=0.03)


@pytest.mark.slow  # much is compiled
def test_free_quadrilaterals_that_are_not_convex_cannot_be():
    dent = np.array([2.0, 3.0, 12.0, 3.0, 5.0, 6.0, 2.0, 13.0])
    square = np.array([2.0, 3.0, 12.0, 3.0, 12.0, 13.0, 2.0, 13.0])
    assert log_prior.compiled(FREE, 4, dent, prior(1.0)) == -math.inf
    assert log_prior.compiled(FREE, 4, square, prior(1.0)) > -math.inf


@pytest.mark.parametrize(
    "by",
    [plainly, pytest.param(compiled, marks=pytest.mark.slow)],  # compiled for it alone: 2 s
)
def test_an_outline_is_pulled_onto_the_pad(by):
    p = np.array([0.0, 25.0, 9.0, 0.1, 0.3])
    known = prior(1.0, largest=9.5)
    assert by(log_prior)(RECTANGLE, 0, p, known) == -math.inf
    by(pulled_in)(RECTANGLE, 0, p, known)
    assert by(log_prior)(RECTANGLE, 0, p, known) > -math.inf
