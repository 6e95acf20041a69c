"""What a frame's own readings say of the noise in them, from the part that nothing touches."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tactile_graph.compiled import compiled_later, compiled_twin_of
from tactile_graph_filters.readings.ordered import in_order
from tactile_graph_likelihood.geometry.outlines import Values

UNTOUCHED = 0.25
"""Share of a frame that is taken to be untouched at least: its closest readings are the zero."""

WIDTH = 0.637
"""Of that stretch, in standard deviations of normal noise, were all of the frame untouched: where
much is touched the noise comes out up to twice too large, never too small."""

FEWEST = 4
"""Readings below zero, for there to be any noise, or above the most that others read."""


class FrameNoise(NamedTuple):
    """Zero and noise of a frame's readings, in the readings' unit.

    Parameters
    ----------
    zero : float
        What untouched elements read.
    sigma : float
        Standard deviation of a reading around it.
    step : float
        Least difference of two readings: a converter's step, next to nothing without one.
    """

    zero: float
    sigma: float
    step: float


def frame_noise(readings: Values) -> FrameNoise:
    """Return zero and noise of the readings of a frame.

    Parameters
    ----------
    readings : ndarray, shape (N,)
        Of all elements that work, raw.

    Notes
    -----
    The zero is the middle of the shortest stretch that holds a quarter of the readings; the noise
    is what lies below it, and the stretch's own width. Where that many read the same, hardly any
    more, and as many less, these are saturated: the zero is then among the others.
    """
    return FrameNoise(*noise_of_sorted.call(in_order(readings)))


def _noise_plain(values: Values) -> tuple[float, float, float]:
    """Return zero, noise and step of readings in ascending order, zeros if there are none."""
    n = len(values)
    if n == 0:
        return 0.0, 0.0, 0.0
    steps = values[1:] - values[:-1]
    steps = steps[steps > 0.0]
    step = float(steps.min()) if len(steps) else 0.0
    many = max(int(UNTOUCHED * n), 1)
    widths = values[many - 1 :] - values[: n - many + 1]
    at = int(widths.argmin())
    if at >= many and is_saturated(values, at, many):
        at = int(widths[: at - many + 1].argmin())
    zero = 0.5 * float(values[at] + values[at + many - 1])
    below = zero - values[: int(values.searchsorted(zero))]
    if len(below) < FEWEST:
        return zero, 0.0, step
    total = float(np.add.accumulate(below * below)[-1])  # one by one, as loops add
    return zero, max(math.sqrt(total / len(below)), float(widths[at]) / WIDTH), step


@compiled_twin_of(_noise_plain)
def noise_of_sorted(values):  # type: ignore[no-untyped-def]
    """Do the same in loops."""
    n = values.shape[0]
    if n == 0:
        return 0.0, 0.0, 0.0
    step = np.inf
    for i in range(n - 1):
        rise = values[i + 1] - values[i]
        if 0.0 < rise < step:
            step = rise
    if step == np.inf:
        step = 0.0
    many = max(int(UNTOUCHED * n), 1)
    at, width = closest(values, many, n - many + 1)
    if at >= many and is_saturated(values, at, many):
        at, width = closest(values, many, at - many + 1)
    zero = 0.5 * (values[at] + values[at + many - 1])
    below, total = 0, 0.0
    while below < n and values[below] < zero:
        total += (zero - values[below]) * (zero - values[below])
        below += 1
    if below < FEWEST:
        return zero, 0.0, step
    return zero, max(math.sqrt(total / below), width / WIDTH), step


@compiled_later
def closest(values: Values, many: int, starts: int) -> tuple[int, float]:
    """Return where the shortest of as many stretches of ``many`` readings begins, and its width."""
    at, width = 0, values[many - 1] - values[0]
    for i in range(1, starts):
        its = values[i + many - 1] - values[i]
        if its < width:
            at, width = i, its
    return at, width


@compiled_later
def is_saturated(values: Values, at: int, many: int) -> bool:
    """Return whether ``many`` readings from ``at`` on are all the same and hardly any is larger."""
    n = values.shape[0]
    return bool(values[at] == values[at + many - 1] and values[max(n - FEWEST, at)] == values[at])
