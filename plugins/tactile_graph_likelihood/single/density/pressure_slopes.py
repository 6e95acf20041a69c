"""How the load on each element grows with what the pressure is told by: outline, fall and lean."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.covered import Box
from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.single.density.element_terms import FALL, LEAN_X, LEAN_Y
from tactile_graph_likelihood.single.density.load_shares import (
    LEAST_FALL,
    MOST_FALL,
    NARROW,
    RIM,
    distance,
    gauge,
    leans_per_cm,
)
from tactile_graph_likelihood.single.density.problem import Places


class Laid(NamedTuple):
    """An outline, what its pressure is told by, and the window of a grid that it is laid on.

    All as in `load_shares.press`.
    """

    kind: int
    corners: int
    p: Values
    grid: Values
    noise: Values
    box: Box


class Pressed(NamedTuple):
    """What the pressure is on each element of a window, and how it came about, (rows, columns).

    ``times`` is the pressure over the mean, ``tilt`` the logarithm of what a lean makes of it; an
    element's middle is ``far`` from the centre over the outline's extent, which grows ``steep``
    per cm; ``by_far``, ``by_steep`` and ``by_fall`` are the pressure's slopes.
    """

    times: Values
    tilt: Values
    far: Values
    steep: Values
    by_far: Values
    by_steep: Values
    by_fall: Values


@compiled_as_is
def is_pressed(estimated: Places) -> bool:
    """Return whether a pressure is estimated."""
    found = False
    for k in range(estimated.shape[0]):
        found = found or FALL <= estimated[k] <= LEAN_Y
    return found


@compiled_as_is
def press_with_slopes(
    laid: Laid, estimated: Places, steps: Values, share: Values, rise: Values
) -> None:
    """Weigh coverage and its slopes, in place, by the pressure; write slopes along its own numbers.

    Parameters
    ----------
    laid : Laid
    estimated : ndarray of int, shape (M,)
        As in `Problem`.
    steps : ndarray, shape (N,)
        Over how much each of the outline's numbers is varied where it moves an element's place.
    share : ndarray, shape (rows, columns)
        Coverage of the window; changed.
    rise : ndarray, shape (N + 1 + M or fewer, rows, columns)
        Its slopes; changed.
    """
    p, noise = laid.p, laid.noise
    pressed = _pressed(laid, share)
    for k in range(estimated.shape[0]):
        place, along = estimated[k], steps.shape[0] + 1 + k
        if place == FALL and LEAST_FALL <= noise[FALL] <= MOST_FALL:
            rise[along] = share * pressed.by_fall
        elif place in (LEAN_X, LEAN_Y):
            _lean_more(laid, place, share, pressed.times, rise[along])
    at = p.copy()
    moved = Laid(laid.kind, laid.corners, at, laid.grid, noise, laid.box)
    for k in range(steps.shape[0]):
        at[k] += steps[k]
        _move(moved, share, pressed, steps[k], rise[k])
        at[k] = p[k]
    share *= pressed.times


@compiled_as_is
def _pressed(laid: Laid, share: Values) -> Pressed:
    """Return the pressure on each element that is covered."""
    kind, corners, p, grid, noise, box = laid
    all_of = np.zeros((7, share.shape[0], share.shape[1]))
    found = Pressed(
        all_of[0], all_of[1], all_of[2], all_of[3], all_of[4], all_of[5], all_of[6]
    )  # fmt: skip
    times, tilts, fars, steeps, by_far, by_steep, by_fall = found
    fall, half = min(max(noise[FALL], LEAST_FALL), MOST_FALL), 0.5 * grid[3]
    lean_x, lean_y = leans_per_cm(kind, corners, p, noise)
    centre_x, centre_y, lines = gauge(kind, corners, p)
    first_x, first_y = grid[0] + half - centre_x, grid[1] + half - centre_y
    for i in range(share.shape[0]):
        y = first_y + (box[0] + i) * grid[2]
        for j in range(share.shape[1]):
            if share[i, j] <= 0.0:
                continue
            x = first_x + (box[1] + j) * grid[2]
            tilt = lean_x * x + lean_y * y
            far, steep = distance(kind, lines, x, y)
            level = 1.0 if tilt == 0.0 else math.exp(tilt)
            mean, along, wide, of_fall = mean_pressure_with_slopes(far, half * steep, fall)
            times[i, j], tilts[i, j] = level * mean, tilt
            fars[i, j], steeps[i, j] = far, steep
            by_far[i, j], by_steep[i, j] = level * along, level * half * wide
            by_fall[i, j] = level * of_fall
    return found


@compiled_as_is
def _move(moved: Laid, share: Values, pressed: Pressed, step: float, rise: Values) -> None:
    """Weigh the slope along a number by the pressure; add how that moves with the outline."""
    kind, corners, at, grid, noise, box = moved
    times, tilts, fars, steeps, by_far, by_steep, _ = pressed
    lean_x, lean_y = leans_per_cm(kind, corners, at, noise)
    centre_x, centre_y, lines = gauge(kind, corners, at)
    first_x, first_y = grid[0] + 0.5 * grid[3] - centre_x, grid[1] + 0.5 * grid[3] - centre_y
    falls, per_step = noise[FALL] != 0.0, 1.0 / step
    for i in range(share.shape[0]):
        y = first_y + (box[0] + i) * grid[2]
        for j in range(share.shape[1]):
            if share[i, j] <= 0.0:
                rise[i, j] = 0.0
                continue
            x = first_x + (box[1] + j) * grid[2]
            change = times[i, j] * (lean_x * x + lean_y * y - tilts[i, j])
            if falls:
                far, steep = distance(kind, lines, x, y)
                change += by_far[i, j] * (far - fars[i, j])
                change += by_steep[i, j] * (steep - steeps[i, j])
            rise[i, j] = rise[i, j] * times[i, j] + share[i, j] * change * per_step


@compiled_as_is
def _lean_more(laid: Laid, place: int, share: Values, times: Values, rise: Values) -> None:
    """Write the slope along a lean, to the right or down as ``place`` says."""
    kind, corners, p, grid, _, box = laid
    one = np.zeros(LEAN_Y + 1)
    one[place] = 1.0
    right, down = leans_per_cm(kind, corners, p, one)
    centre_x, centre_y, _ = gauge(kind, corners, p)
    first_x, first_y = grid[0] + 0.5 * grid[3] - centre_x, grid[1] + 0.5 * grid[3] - centre_y
    for i in range(share.shape[0]):
        y = first_y + (box[0] + i) * grid[2]
        for j in range(share.shape[1]):
            x = first_x + (box[1] + j) * grid[2]
            rise[i, j] = share[i, j] * times[i, j] * (right * x + down * y)


@compiled_as_is
def mean_pressure_with_slopes(
    r: float, reach: float, fall: float
) -> tuple[float, float, float, float]:
    """Return `load_shares.mean_pressure` and its slopes along its three arguments."""
    inner, outer = max(r - reach, 0.0), r + reach
    q_in, q_out = max(1.0 - inner * inner, RIM), max(1.0 - outer * outer, 0.0)
    in_by_r = -2.0 * inner if q_in > RIM else 0.0
    out_by_r = -2.0 * outer if q_out > 0.0 else 0.0
    middle, wide = 0.5 * (q_in + q_out), q_in - q_out
    half, power = wide / middle, 1.0 + fall
    if half < NARROW:
        log = math.log(middle)
        level = power * math.exp(fall * log)
        bend = fall * (fall - 1.0) / 24.0 * half * half
        mean = level * (1.0 + bend)
        by_middle, by_half = fall * mean / middle, level * fall * (fall - 1.0) / 12.0 * half
        by_in = 0.5 * by_middle + by_half * (1.0 - 0.5 * half) / middle
        by_out = 0.5 * by_middle - by_half * (1.0 + 0.5 * half) / middle
        by_fall = mean * (1.0 / power + log) + level * (2.0 * fall - 1.0) / 24.0 * half * half
    else:
        log_in = math.log(q_in)
        raised_in = math.exp(power * log_in)
        rising, by_fall, raised_out, steep_out = raised_in, raised_in * log_in, 0.0, 0.0
        if q_out > 0.0:
            log_out = math.log(q_out)
            raised_out = math.exp(power * log_out)
            by_fall -= raised_out * log_out
            # of a face that presses with its rim the slope is that of the rim's, not endless
            steep_out = raised_out / (max(q_out, RIM) if fall < 0.0 else q_out)
        mean, by_fall = (rising - raised_out) / wide, by_fall / wide
        by_in = (power * raised_in / q_in - mean) / wide
        by_out = (mean - power * steep_out) / wide if q_out > 0.0 else 0.0
    by_r = by_in * in_by_r + by_out * out_by_r
    by_reach = by_out * out_by_r - by_in * in_by_r
    return mean, by_r, by_reach, by_fall
