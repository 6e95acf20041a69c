"""Images that the likelihood's own model has made, and the numbers its kernels take."""

from __future__ import annotations

import numpy as np

from tactile_graph.wires import Image
from tactile_graph_likelihood.covered import covered
from tactile_graph_likelihood.noise import Noise
from tactile_graph_likelihood.outlines import packed
from tactile_graph_likelihood.readings import readings_of

GRID = np.array([0.0, 0.0, 1.3, 1.0, 0.0, 0.0])
NOISE = Noise(0.48, 0.16, 1e-3, 5.0)
NOTHING = (np.zeros(0, np.int64),)


def drawn(shape, load_g, rng, sigma=0.48, voids=0.16, least_g=5.0, side=16):
    """Return an image in grams drawn from the model: voids, lognormal gains, a threshold."""
    kind, corners, p = packed(shape)
    share = covered.reference(kind, corners, p, GRID, (0, 0, side, side))
    gains = np.exp(sigma * rng.standard_normal(share.shape)) * (rng.random(share.shape) >= voids)
    load = load_g * share * gains
    load[load < least_g] = 0.0
    return Image(load, (1.3, 1.3), (-0.15, -0.15), "gram")


def kernel_arguments(shape, load_g, rng, noise=NOISE):
    """Return what `log_likelihood` takes for a shape and an image drawn from it."""
    readings = readings_of(drawn(shape, load_g, rng), 0.3, noise.least)
    kind, corners, p = packed(shape)
    point = np.append(p, np.log(load_g))
    return kind, corners, point, readings.grid, readings.logs, readings.states, noise.vector(1.3)
