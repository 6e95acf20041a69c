"""Posteriors that are wider, or elsewhere, for what the outline's own fit does not tell."""

from __future__ import annotations

import math

from tactile_graph_likelihood.any_pad.uncertainty.posterior import VAGUE, AnyPadPosterior
from tactile_graph_likelihood.geometry.outlines import sizes
from tactile_graph_likelihood.single.changed import changed
from tactile_graph_likelihood.single.readings import Readings

EVENLY = 2.0
"""Independent points that one of an evenly spread rectangle's points is worth."""

CENTRE_STD, SIZE_STD = 0.12, 0.3
"""Of a pitch: what filtered readings leave uncertain of a centre and of sizes beside what is told
of readings that are each their own."""


def evenly_spread(found: AnyPadPosterior) -> AnyPadPosterior:
    """Return a rectangle's posterior whose points are worth what those around a clear top are."""
    return changed(found, evenly=EVENLY)


def resized(found: AnyPadPosterior, share: float) -> AnyPadPosterior:
    """Return a posterior whose sizes may all be larger, or smaller, by a share of them."""
    lengths = slice(2, 2 + sizes.call(found.kind))
    off, covariance = share * found.mean[lengths], found.covariance.copy()
    covariance[lengths, lengths] += off[:, None] * off
    return changed(found, covariance=covariance)


def unsized(found: AnyPadPosterior, std_cm: float) -> AnyPadPosterior:
    """Return a posterior whose sizes may all be larger, or smaller, by a length."""
    if std_cm == 0.0:
        return found
    lengths, covariance = slice(2, 2 + sizes.call(found.kind)), found.covariance.copy()
    covariance[lengths, lengths] += std_cm * std_cm
    return changed(found, covariance=covariance)


def within(found: AnyPadPosterior, smallest_cm: float, largest_cm: float) -> AnyPadPosterior:
    """Return a posterior whose mean, top and points have no sizes that there cannot be.

    On a single row of cells widths are known by what there can be, and by nothing else: normal
    distributions, and points pushed apart, reach beyond it.
    """
    lengths = slice(2, 2 + sizes.call(found.kind))
    mean, points, top = found.mean.copy(), found.points.copy(), found.most_likely.copy()
    for its in (mean[lengths], points[:, lengths], top[lengths]):
        its.clip(smallest_cm, largest_cm, out=its)
    return changed(found, mean=mean, points=points, most_likely=top)


def stretched(found: AnyPadPosterior, readings: Readings) -> AnyPadPosterior:
    """Return a posterior at its place on cells as wide and high as they are, not on square ones."""
    if readings.stretch == 1.0:
        return found
    mean, points, likeliest = found.mean.copy(), found.points.copy(), found.most_likely.copy()
    covariance, root = found.covariance.copy(), math.sqrt(readings.stretch)
    for axis, factor in enumerate((1.0 / root, root)):
        begin_cm = float(readings.grid[axis])
        for along in (mean[axis : axis + 1], points[:, axis], likeliest[axis : axis + 1]):
            along += (factor - 1.0) * (along - begin_cm)
        covariance[axis] *= factor
        covariance[:, axis] *= factor
    return changed(found, mean=mean, points=points, most_likely=likeliest, covariance=covariance)


def as_filtered(found: AnyPadPosterior, pitch_cm: float) -> AnyPadPosterior:
    """Return a posterior as uncertain as readings leave it that are not each their own.

    Whether it ``fits`` is judged as before.
    """
    centre, covariance = (CENTRE_STD * pitch_cm) ** 2, found.covariance.copy()
    lengths = 2 + sizes.call(found.kind)
    for k in range(lengths):
        covariance[k, k] += centre if k < 2 else (SIZE_STD * pitch_cm) ** 2
    usual_cm = math.hypot(found.usual_std_cm, math.sqrt(2.0 * centre) / VAGUE)
    return changed(found, covariance=covariance, usual_std_cm=usual_cm, filtered=True)
