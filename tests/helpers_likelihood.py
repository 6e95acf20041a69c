"""Images that the likelihood's own model has made, and the numbers its kernels take."""

from __future__ import annotations

import numpy as np

from helpers_modes import plainly
from tactile_graph.steps.signature import read_signature
from tactile_graph.wires import Image
from tactile_graph_likelihood.geometry.covered import covered
from tactile_graph_likelihood.geometry.outlines import packed
from tactile_graph_likelihood.single.density.problem import problem_of
from tactile_graph_likelihood.single.noise import Noise
from tactile_graph_likelihood.single.readings import readings_of

GRID = np.array([0.0, 0.0, 1.3, 1.0, 0.0, 0.0])
NOISE = Noise(0.48, 0.16, 1e-3, 5.0)


def drawn(shape, load_g, rng, sigma=0.48, voids=0.16, least_g=5.0, side=16):
    """Return an image in grams drawn from the model: voids, lognormal gains, a threshold."""
    kind, corners, p = packed(shape)
    share = plainly(covered)(kind, corners, p, GRID, (0, 0, side, side))
    gains = np.exp(sigma * rng.standard_normal(share.shape)) * (rng.random(share.shape) >= voids)
    load = load_g * share * gains
    load[load < least_g] = 0.0
    return Image(load, (1.3, 1.3), (-0.15, -0.15), "gram")


def problem_and_point(shape, load_g, rng, noise=NOISE):
    """Return what `log_likelihood` takes for a shape and an image drawn from it."""
    readings = readings_of(drawn(shape, load_g, rng), 0.3, noise.least)
    kind, corners, p = packed(shape)
    point = np.append(p, np.log(load_g))
    size, prior = readings.size_cm, np.zeros(9)
    prior[:6] = *readings.grid[:2], *size, 0.5, 20.0
    vector, places, guess = noise.as_taken(1.3)
    problem = problem_of(kind, corners, *readings[:3], vector, prior)
    return problem._replace(estimated=places, guess=guess), point


def made(step, **settings):
    """Return a step as a pipeline makes it: settings flat, the others by default."""
    return step(**read_signature(step.__name__, step).arguments(settings))
