"""What readings leave open of an outline, beyond what its fit tells: variances of its lengths."""

from __future__ import annotations

from tactile_graph_likelihood.geometry.outlines import DISC, Values
from tactile_graph_likelihood.single.readings import Readings

UNSEEN, NO_FALL, SOME_FALL = 0.06, -0.5, 1.0
"""Share of a rectangle's sizes by which a fall to its rim may make it look smaller, unseen, where
residuals fall by so many deviations; none where they fall by fewer than the second number."""

PATTERN = 3.0
"""Pattern left over from which on an outline is not taken to press evenly where no pressure is
looked at: on wide outlines, and where a quick answer will do."""

HIDDEN = 0.25
"""Of a pitch: by how much foam, or a face that falls to its rim, moves an edge unseen."""

FEW, LOOSE = 20, 0.3
"""Touched elements of an outline so small that a void looks like its rim, and the deviation in
pitches that is added to where its posterior is first looked for."""

FAINT_TOUCH, SPARSE = 5, 8.0
"""Touched elements, and how many times as many an outline around them covers, where they are rather
noise."""


def unseen_share(fall: float) -> float:
    """Return the share of a fall to the rim that may be there by what residuals show of it."""
    return min(max((fall - NO_FALL) / (SOME_FALL - NO_FALL), 0.0), 1.0)


def hidden_by(pattern: float, readings: Readings) -> float:
    """Return the variance in cm^2 of an edge that pressure may move where a pattern is left over.

    It grows with the pattern until that is `PATTERN`.
    """
    share = min(max(pattern / PATTERN, 0.0), 1.0)
    return (share * HIDDEN * float(readings.grid[2])) ** 2


def is_scattered(kind: int, readings: Readings, p: Values) -> bool:
    """Return whether a few touched elements lie far apart in an outline, as where noise shows."""
    if readings.touched > FAINT_TOUCH:
        return False
    a, b = (p[2], p[2]) if kind == DISC else (p[2], p[3])
    return bool(4.0 * a * b >= SPARSE * readings.touched * readings.grid[2] ** 2)


def fewness(readings: Readings) -> float:
    """Return 0 where many elements are touched, up to 1 the fewer than `FEW` they are."""
    return max(1.0 - readings.touched / FEW, 0.0)


def looseness(readings: Readings) -> float:
    """Return the variance in cm^2 by which an outline is less certain where few are touched."""
    return fewness(readings) * (LOOSE * float(readings.grid[2])) ** 2
