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

ALIKE = 1e-3
"""Of a converter's step, by which stretches of whole steps differ in width by rounding alone."""


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
    is what lies below it, and the stretch's own width. Where a converter's steps are so coarse that
    several overlapping stretches are the shortest, the zero is the mean of their middles, and of
    those that read about that the share counts as below it that would be without the steps. Where
    that many read the same, hardly any more, and as many less, these are saturated: the zero is
    then among the others.
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
    at = int(np.argmax(widths <= widths.min() + ALIKE * step))
    if at >= many and is_saturated(values, at, many):
        widths = widths[: at - many + 1]
        at = int(np.argmax(widths <= widths.min() + ALIKE * step))
    zero, are_several = _middle_plain(values, many, widths, at, step)
    half = 0.5 * step if are_several else 0.0
    off = zero - values[: int(values.searchsorted(zero + half))]
    shares = np.minimum(off / step + 0.5, 1.0) if are_several else np.ones(len(off))
    below = float(np.add.accumulate(shares)[-1]) if len(off) else 0.0  # one by one, as loops add
    if below < FEWEST:
        return zero, 0.0, step
    total = float(np.add.accumulate(shares * (off * off))[-1])
    return zero, max(math.sqrt(total / below), float(widths[at]) / WIDTH), step


def _middle_plain(
    values: Values, many: int, widths: Values, at: int, step: float
) -> tuple[float, bool]:
    """Return the mean middle of the shortest stretches from ``at`` on, and if there are several.

    Each overlaps the one before: as short ones farther up are of a load.
    """
    starts = at + np.flatnonzero(widths[at:] <= widths[at] + ALIKE * step)
    first, last = values[starts], values[starts + many - 1]
    apart = np.flatnonzero(first[1:] > last[:-1])
    n = int(apart[0]) + 1 if len(apart) else len(starts)
    if first[0] == first[n - 1]:
        return 0.5 * float(first[0] + last[0]), False
    return 0.5 * float(np.add.accumulate(first[:n] + last[:n])[-1]) / n, True


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
    starts = n - many + 1
    at, width = closest(values, many, starts, ALIKE * step)
    if at >= many and is_saturated(values, at, many):
        starts = at - many + 1
        at, width = closest(values, many, starts, ALIKE * step)
    zero, are_several = middle(values, many, starts, at, width + ALIKE * step)
    half = 0.5 * step if are_several else 0.0
    below, total = 0.0, 0.0
    for i in range(n):
        if not values[i] < zero + half:
            break
        off = zero - values[i]
        share = min(off / step + 0.5, 1.0) if are_several else 1.0
        below += share
        total += share * (off * off)
    if below < FEWEST:
        return zero, 0.0, step
    return zero, max(math.sqrt(total / below), width / WIDTH), step


@compiled_later
def closest(values: Values, many: int, starts: int, slack: float) -> tuple[int, float]:
    """Return where the shortest of as many stretches of ``many`` readings begins, and its width.

    Of several, up to ``slack`` wider, the lowest.
    """
    width = values[many - 1] - values[0]
    for i in range(1, starts):
        width = min(width, values[i + many - 1] - values[i])
    at = 0
    while values[at + many - 1] - values[at] > width + slack:
        at += 1
    return at, values[at + many - 1] - values[at]


@compiled_later
def middle(values: Values, many: int, starts: int, at: int, most: float) -> tuple[float, bool]:
    """Do what `_middle_plain` does in loops, with the width up to which stretches are as short."""
    last, n, total = at, 0, 0.0
    for i in range(at, starts):
        if values[i] > values[last + many - 1]:
            break
        if values[i + many - 1] - values[i] <= most:
            last = i
            n += 1
            total += values[i] + values[i + many - 1]
    if values[last] == values[at]:
        return 0.5 * (values[at] + values[at + many - 1]), False
    return 0.5 * total / n, True


@compiled_later
def is_saturated(values: Values, at: int, many: int) -> bool:
    """Return whether ``many`` readings from ``at`` on are all the same and hardly any is larger."""
    n = values.shape[0]
    return bool(values[at] == values[at + many - 1] and values[max(n - FEWEST, at)] == values[at])
