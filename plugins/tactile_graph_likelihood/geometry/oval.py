"""An ellipse in numbers in which a circle is nothing special.

Centre x and y, the mean m of the half axes, and half their difference d in the directions of
twice the angle: ``d cos 2t`` and ``d sin 2t``. To first order the outline is
``m + d cos(2 (phi - t))`` from its centre, linear in the last three; an ellipse that is nearly
round has one top here, where half axes and angle have a ring of them.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.lengths import length

ROUND = 1e-3  # d over m: rounder outlines count as this round where d divides


@compiled_as_is
def as_ellipse(p: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the numbers of an oval, and what follows them, as those of an `ELLIPSE`.

    The first half axis is the longer one, its angle in (-pi / 2, pi / 2].
    """
    found = p.copy()
    d = length(p[3], p[4])
    found[2], found[3], found[4] = p[2] + d, p[2] - d, 0.5 * math.atan2(p[4], p[3])
    return found


@compiled_as_is
def to_oval(p: NDArray[np.float64]) -> None:
    """Turn the numbers of an `ELLIPSE` into those of an oval, in place."""
    m, d, twice = 0.5 * (p[2] + p[3]), 0.5 * (p[2] - p[3]), 2.0 * p[4]
    p[2], p[3], p[4] = m, d * math.cos(twice), d * math.sin(twice)


@compiled_as_is
def log_stretch(p: NDArray[np.float64]) -> float:
    """Return ln of an ellipse's volume of half axes and angle over that of an oval's numbers."""
    stretch: float = -math.log(max(length(p[3], p[4]), ROUND * p[2]))
    return stretch


@compiled_as_is
def to_ellipses(points: NDArray[np.float64], weights: NDArray[np.float64]) -> None:
    """Turn weighted ovals into `ELLIPSE` numbers in place, angles within pi / 4 of the mean's."""
    along = across = 0.0
    for i in range(points.shape[0]):
        along += weights[i] * points[i, 3]
        across += weights[i] * points[i, 4]
    middle = 0.5 * math.atan2(across, along)
    for i in range(points.shape[0]):
        points[i, :] = as_ellipse(points[i])
        quarters = round((points[i, 4] - middle) / (0.5 * math.pi))
        points[i, 4] -= quarters * 0.5 * math.pi
        if quarters % 2 != 0:
            points[i, 2], points[i, 3] = points[i, 3], points[i, 2]
