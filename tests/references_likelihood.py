"""What kernels of tactile_graph_likelihood are held against: the same answers, vectorised."""

from __future__ import annotations

import math

import numpy as np

from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.single.density.element_terms import (
    CONTRAST,
    HIGH,
    LEAST,
    OFF,
    ON,
    OVER,
    SIGMA,
    SQRT_HALF,
    STRAYS,
    UNDER,
    VOIDS,
    States,
    on_level,
)
from tactile_graph_pads.coverage.ellipse import ellipse_areas


def disc_areas(
    x_cm: float,
    y_cm: float,
    radius_cm: float,
    pitch_cm: float,
    element_cm: float,
    rows: int,
    columns: int,
) -> Values:
    """Return the area of the disc on each element, in cm^2, shape (rows, columns)."""
    return ellipse_areas.reference(
        x_cm, y_cm, radius_cm, radius_cm, 0.0, pitch_cm, element_cm, rows, columns
    )


def split(values: Values, least: float, logs: Values, states: States) -> int:
    """Write logarithms and states of readings; return how many show, -1 if one is NaN."""
    if not np.isfinite(values).all():
        return -1
    shows = (values > 0.0) & (values >= least)
    logs[...] = np.log(np.where(shows, values, 1.0))
    states[...] = np.where(shows, ON, OFF)
    return int(shows.sum())


def ranked(values: Values, rank: int) -> float:
    """Return the value that so many, less one, are at least as large as."""
    return float(np.partition(values, -rank, axis=None)[-rank])


def terms(
    shares: Values, load: float, row: int, column: int, logs: Values, states: States, noise: Values
) -> float:
    """Return the log likelihood of a window's readings over that of a bare pad."""
    rows, columns = shares.shape
    here = np.s_[row : row + rows, column : column + columns]
    touched = shares > 0.0
    mu = load + noise[CONTRAST] * np.log(np.where(touched, shares, 1.0))
    sigma, voids, least = noise[SIGMA], noise[VOIDS], noise[LEAST]
    u = (logs[here] - mu) / sigma
    on = np.logaddexp(0.0, on_level.call(noise) - 0.5 * u * u)
    z = (mu - np.where(states[here] == OFF, least, logs[here])) / sigma
    tail = np.array([[0.5 * math.erfc(-SQRT_HALF * e) for e in line] for line in z.tolist()])
    tail = tail.reshape(z.shape)
    off = np.log(1.0 - (1.0 - voids) * tail)
    over = np.log1p((1.0 - noise[STRAYS]) * (1.0 - voids) / (HIGH * noise[STRAYS]) * tail)
    of = {ON: on, OFF: off, UNDER: off, OVER: over}
    found = sum(np.where(states[here] == state, its, 0.0) for state, its in of.items())
    return float(found[touched].sum())
