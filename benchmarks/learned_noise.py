"""``learned_noise``: a pad's unevenness from images of objects whose place is not known.

The command ``learn-pad`` learns it from recordings of any objects; this asks what they are.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from tactile_graph.errors import Degenerate
from tactile_graph.wires import Image
from tactile_graph_likelihood.geometry.outlines import unknowns
from tactile_graph_likelihood.single.model import Model
from tactile_graph_likelihood.single.noise import Noise

ROUNDS = 2

MOST_POINTS = 4096
"""Of a posterior: what it weighs here is its width, and few points promise too much."""

POOR = 0.5
"""Share of the equal points asked for below which a posterior is passed over."""


def learned_noise(model: Model, images: Iterable[Image]) -> Noise:
    """Return a model's noise with sigma and voids as a recording shows them.

    Parameters
    ----------
    model : Model
        Kind of outline and first guess of the noise.
    images : iterable of Image
        Loads, one object of that kind on each; images without an answer, or with one that too few
        points are behind, are passed over.

    Raises
    ------
    Degenerate
        If no image has an answer.

    Notes
    -----
    Both are estimated with the object in each image. The image's guess is taken off its answer
    (a product of normal densities), and what is left is averaged by its precision. A void's log
    odds are not normal, least so far from the guess, so it is done twice: the second time the
    guess is what the first has found.
    """
    images = list(images)
    found = model.noise
    for _ in range(ROUNDS):
        found = _averaged(replace(model, noise=found), images)
    return found


def _averaged(model: Model, images: list[Image]) -> Noise:
    """Return the noise by all images, each read with the model's as its guess."""
    noise = replace(model.noise, estimated=("sigma", "voids"))
    asked = replace(model, noise=noise, most_points=max(model.most_points, MOST_POINTS))
    first = unknowns.call(model.kind, model.corners) + 1
    total, weights = np.zeros(2), np.zeros(2)
    for image in images:
        try:
            found = asked.posterior(image)
        except Degenerate:
            continue
        if found.equal_points < POOR * model.precision**-2:
            continue
        guess = noise.as_taken(float(image.pitch_cm[0])).guess
        own = 1.0 / np.diag(found.covariance)[first:] - guess[:, 1] ** -2
        own = np.maximum(own, 1e-3 * guess[:, 1] ** -2)
        middle = (found.mean[first:] - guess[:, 0]) * (1.0 + guess[:, 1] ** -2 / own) + guess[:, 0]
        total += own * middle
        weights += own
    if not weights.all():
        raise Degenerate("no image holds such an object: there is nothing to learn from")
    log_sigma, odds = total / weights
    sigma, voids = math.exp(log_sigma), 1.0 / (1.0 + math.exp(-odds))
    return replace(model.noise, sigma=sigma, voids=voids, estimated=())
