"""Sizes of an outline from what its touched elements measured, before any image is read again."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tactile_graph_likelihood.geometry.covered import covered
from tactile_graph_likelihood.geometry.outlines import (
    DISC,
    ELLIPSE,
    RECTANGLE,
    REGULAR,
    Values,
    sizes,
)
from tactile_graph_likelihood.known.known_sizes import KnownSizes
from tactile_graph_likelihood.single.density.element_terms import LEAST, SIGMA, VOIDS
from tactile_graph_likelihood.single.model import Model
from tactile_graph_likelihood.single.readings import Readings

PLACES = 6
ROUNDS = 6
STEP = 0.02
CAREFUL = 0.02
"""Of a size: how far off the model itself may be."""

FEATURES = {1: ("area_cm2",), 2: ("semi_major_cm", "semi_minor_cm")}
"""What sizes are found from, by how many there are."""


class Touching(NamedTuple):
    """How a pad's elements are touched: the model, its grid, and an object's weight in grams."""

    model: Model
    grid: Readings
    weight: float
    level: float


def sizes_from(kind: int, corners: int, at: Touching, readings: Values) -> KnownSizes:
    """Return the sizes that explain the mean of some readings of an object's features.

    Parameters
    ----------
    kind, corners : int
        Of the outline, as in `outlines`.
    at : Touching
    readings : ndarray, shape (n, F)
        The features named in `FEATURES`.

    Notes
    -----
    Newton's method on the logarithms. An element is expected to be touched as the model has it,
    at a few places that are spread over one pitch; the readings' scatter over their number gives
    the covariance, and 2 % of each size are added.
    """
    logs = np.log(np.maximum(readings, 1e-9))
    wanted, n = logs.mean(axis=0), len(logs)
    scatter = np.atleast_2d(np.cov(logs.T)) if n > 1 else np.eye(logs.shape[1]) * 0.01
    found = np.log(_first(kind, corners, readings.mean(axis=0)))
    slopes = np.eye(len(found))
    for _ in range(ROUNDS):
        here = _expected(kind, corners, at, found)
        for k in range(len(found)):
            up = found.copy()
            up[k] += STEP
            slopes[:, k] = (_expected(kind, corners, at, up) - here) / STEP
        step = np.linalg.solve(slopes, wanted - here)
        found = found + np.clip(step, -0.3, 0.3)
        if np.abs(step).max() < 1e-3:
            break
    back = np.linalg.inv(slopes)
    spread = back @ (scatter / n) @ back.T + CAREFUL**2 * np.eye(len(found))
    values = np.exp(found)
    return KnownSizes(values, spread * np.outer(values, values))


def _first(kind: int, corners: int, features: Values) -> Values:
    """Return sizes whose own area or moments are those of the touched cells."""
    if kind == DISC:
        return np.sqrt(features / math.pi)
    if kind == REGULAR:
        return np.sqrt(2.0 * features / (corners * math.sin(2.0 * math.pi / corners)))
    return np.maximum(features, 0.3) * (0.5 * math.sqrt(3.0) if kind == RECTANGLE else 1.0)


def _expected(kind: int, corners: int, at: Touching, log_sizes: Values) -> Values:
    """Return the logarithm of the features to be expected of an outline of some sizes."""
    noise = at.model.noise.vector(float(at.grid.grid[2]))
    noise[LEAST] = math.log(at.level)
    rows, columns = at.grid.states.shape
    x, y = np.meshgrid(np.arange(float(columns)), np.arange(float(rows)))
    pitch, found = float(at.grid.grid[2]), []
    width, height = at.grid.size_cm
    for k in range(PLACES):
        turn = (k + 0.5) / PLACES
        p = np.concatenate([[0.5 * width, 0.5 * height], np.exp(log_sizes), [0.5 * math.pi * turn]])
        p[0] += pitch * (turn - 0.5)
        p[1] += pitch * ((2 * k + 1) % PLACES / PLACES - 0.5)
        n = 2 + sizes.call(kind) + (kind in (ELLIPSE, RECTANGLE, REGULAR))
        share = covered.call(kind, corners, p[:n], at.grid.grid, (0, 0, rows, columns))
        chance = _touched(share, at.weight, noise)
        found.append(_features(chance, x, y, pitch))
    mean = np.mean(found, axis=0)
    return np.asarray(np.log(mean[:1] if sizes.call(kind) == 1 else mean[1:]))


def _touched(share: Values, weight: float, noise: Values) -> Values:
    """Return the probability of each element to read more than the least load."""
    sigma, present = noise[SIGMA], 1.0 - noise[VOIDS]
    load = weight / (present * math.exp(0.5 * sigma * sigma) * share.sum())
    mu = np.log(np.maximum(share * load, 1e-300))
    z = (mu - noise[LEAST]) / sigma * math.sqrt(0.5)
    tail = np.array([0.5 * math.erfc(-e) for e in z.ravel().tolist()])
    return np.asarray(present * tail.reshape(share.shape))


def _features(chance: Values, x: Values, y: Values, pitch: float) -> Values:
    """Return area and half axes of the touched cells, as the step `features` measures them.

    Which elements are touched is by chance, and what chance adds to the difference of the axes
    never makes it less: its variance is added to the square.
    """
    n = chance.sum()
    dx, dy = x - (chance * x).sum() / n, y - (chance * y).sum() / n
    own = 1.0 / 12.0
    xx, yy = (chance * dx * dx).sum() / n, (chance * dy * dy).sum() / n
    xy = (chance * dx * dy).sum() / n
    by_chance = chance * (1.0 - chance) / n**2
    off, turn = 0.5 * (dx * dx - xx - dy * dy + yy), dx * dy - xy
    added = (by_chance * (off * off + turn * turn)).sum()
    half = 0.5 * (xx + yy) + own
    apart = math.sqrt(0.25 * (xx - yy) ** 2 + xy * xy + added)
    axes = 2.0 * np.sqrt([half + apart, max(half - apart, 1e-9)])
    return np.array([n * pitch * pitch, *(pitch * axes)])
