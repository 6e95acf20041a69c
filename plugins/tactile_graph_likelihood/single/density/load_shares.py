"""What share of a fully covered element's load an outline brings to each element of a window.

Its coverage, weighed by how the pressure varies, which leans to a side and falls or rises to the
rim, and blurred as by foam.

With r the distance from the centre over that of the outline in the same direction, a place bears
``(1 + fall) (1 - r**2) ** fall * exp(lean_x * u + lean_y * v)`` times the mean: a fall of 0 is an
even face, 1/2 a ball on an elastic pad (Hertz), 1 a ball on a soft layer, below 0 a stiff face or
a cup that presses with its rim. u and v are the offsets from the centre, right and down, over
half the outline's larger extent; of a rectangle or an ellipse each axis is taken to the length 1
instead, so that a lean across it is as likely as one along it. Over any outline that is as wide on
both sides of its centre ``(1 + fall) (1 - r**2) ** fall`` has the mean 1.
"""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.covered import Box, covered, window
from tactile_graph_likelihood.geometry.lengths import length
from tactile_graph_likelihood.geometry.outlines import (
    DISC,
    ELLIPSE,
    OVAL,
    RECTANGLE,
    Values,
    bounds,
    corners_of,
)
from tactile_graph_likelihood.geometry.oval import as_ellipse
from tactile_graph_likelihood.single.density.element_terms import (
    FALL,
    FOAM,
    LEAN_X,
    LEAN_Y,
    SQRT_HALF,
)

FOAM_REACH = 3.5  # widths of the blur
FAINT = 1e-5  # share that foam passes on below which an element is as good as bare
LEAST_FALL, MOST_FALL = -0.7, 3.0
NARROW = 0.5
"""Of 1 - r**2 over an element, over its mean: less is integrated by its series."""

RIM = 0.02
"""Least 1 - r**2 of an element's inner side: where only a corner is covered, r is not known."""


@compiled_as_is
def is_even(noise: Values) -> bool:
    """Return whether the pressure is the same everywhere."""
    even: bool = noise[FALL] == 0.0 and noise[LEAN_X] == 0.0 and noise[LEAN_Y] == 0.0
    return even


@compiled_as_is
def press(
    kind: int, corners: int, p: Values, grid: Values, noise: Values, box: Box, shares: Values
) -> None:
    """Weigh coverage, in place, by the pressure over the mean.

    Parameters
    ----------
    kind, corners, p, grid, box
        As in `covered.covered`.
    noise : ndarray, shape (9,)
        As in `element_terms`; its fall and lean.
    shares : ndarray, shape (rows, columns)
        Coverage of the window; changed.

    Notes
    -----
    Over an element ``1 - r**2`` is taken as uniform between its values half a side further in and
    further out, and the lean as that of its middle. So where the element is partly covered, the
    part beyond the rim is left out.
    """
    fall = min(max(noise[FALL], LEAST_FALL), MOST_FALL)
    leans = noise[LEAN_X] != 0.0 or noise[LEAN_Y] != 0.0
    lean_x, lean_y = leans_per_cm(kind, corners, p, noise)
    centre_x, centre_y, lines = gauge(kind, corners, p)
    half, pitch = 0.5 * grid[3], grid[2]
    first_x, first_y = grid[0] + half - centre_x, grid[1] + half - centre_y
    for i in range(shares.shape[0]):
        y = first_y + (box[0] + i) * pitch
        for j in range(shares.shape[1]):
            if shares[i, j] <= 0.0:
                continue
            x = first_x + (box[1] + j) * pitch
            if leans:
                shares[i, j] *= math.exp(lean_x * x + lean_y * y)
            if fall != 0.0:
                r, steep = distance(kind, lines, x, y)
                shares[i, j] *= mean_pressure(r, half * steep, fall)


@compiled_as_is
def leans_per_cm(kind: int, corners: int, p: Values, noise: Values) -> tuple[float, float]:
    """Return how much the logarithm of the pressure rises a cm to the right, and down."""
    lean_x, lean_y = noise[LEAN_X], noise[LEAN_Y]
    if kind == OVAL:
        p = as_ellipse(p)
    if kind in (ELLIPSE, OVAL, RECTANGLE):
        cos, sin = math.cos(p[4]), math.sin(p[4])
        along = (lean_x * cos - lean_y * sin) / p[2]
        across = (lean_x * sin + lean_y * cos) / p[3]
        return along * cos + across * sin, across * cos - along * sin
    left, top, right, bottom = bounds(kind, corners, p)
    extent = 0.5 * max(right - left, bottom - top)
    return lean_x / extent, lean_y / extent


@compiled_as_is
def mean_pressure(r: float, reach: float, fall: float) -> float:
    """Return the mean of ``(1 + fall) (1 - r**2) ** fall`` from r - reach to r + reach."""
    inner, outer = max(r - reach, 0.0), r + reach
    q_in, q_out = max(1.0 - inner * inner, RIM), max(1.0 - outer * outer, 0.0)
    middle = 0.5 * (q_in + q_out)
    half = (q_in - q_out) / middle
    if half < NARROW:  # the integral's series: good to a ten-thousandth
        bend = fall * (fall - 1.0) / 24.0 * half * half
        return (1.0 + fall) * math.exp(fall * math.log(middle)) * (1.0 + bend)
    power = 1.0 + fall
    mean = math.exp(power * math.log(q_in))
    if q_out > 0.0:
        mean -= math.exp(power * math.log(q_out))
    return mean / (q_in - q_out)


@compiled_as_is
def gauge(kind: int, corners: int, p: Values) -> tuple[float, float, Values]:
    """Return an outline's centre, and the rows of what measures the distance from it.

    Of round outlines two rows: r**2 is the sum of the squares of (row . offset). Of the others a
    row each side: r is the largest of (row . offset).
    """
    if kind == DISC:
        lines = np.zeros((2, 2))
        lines[0, 0] = lines[1, 1] = 1.0 / p[2]
        return p[0], p[1], lines
    if kind in (ELLIPSE, OVAL):
        if kind == OVAL:
            p = as_ellipse(p)
        lines = np.empty((2, 2))
        cos, sin = math.cos(p[4]), math.sin(p[4])
        lines[0, 0], lines[0, 1] = cos / p[2], -sin / p[2]
        lines[1, 0], lines[1, 1] = sin / p[3], cos / p[3]
        return p[0], p[1], lines
    xy = corners_of(kind, corners, p)
    count = xy.shape[0]
    x = y = 0.0
    for k in range(count):
        x += xy[k, 0] / count
        y += xy[k, 1] / count
    if kind == RECTANGLE:
        x, y = p[0], p[1]
    lines = np.empty((count, 2))
    for k in range(count):
        ax, ay = xy[k, 0] - x, xy[k, 1] - y
        bx, by = xy[(k + 1) % count, 0] - x, xy[(k + 1) % count, 1] - y
        cross = ax * by - ay * bx
        lines[k, 0], lines[k, 1] = (by - ay) / cross, -(bx - ax) / cross
    return x, y, lines


@compiled_as_is
def distance(kind: int, lines: Values, x: float, y: float) -> tuple[float, float]:
    """Return an offset's length over the outline's in that direction, and how steeply it grows."""
    if kind in (DISC, ELLIPSE, OVAL):
        a = lines[0, 0] * x + lines[0, 1] * y
        b = lines[1, 0] * x + lines[1, 1] * y
        r = math.sqrt(a * a + b * b)
        if kind == DISC:
            return r, lines[0, 0]
        if r == 0.0:
            return r, math.sqrt(lines[0, 0] * lines[0, 0] + lines[0, 1] * lines[0, 1])
        slope_x = (a * lines[0, 0] + b * lines[1, 0]) / r
        slope_y = (a * lines[0, 1] + b * lines[1, 1]) / r
        return r, length(slope_x, slope_y)
    best, at = -math.inf, 0
    for k in range(lines.shape[0]):
        along = lines[k, 0] * x + lines[k, 1] * y
        if along > best:
            best, at = along, k
    return max(best, 0.0), length(lines[at, 0], lines[at, 1])


@compiled_as_is
def blurred(shares: Values, width: float, box: Box, rows: int, columns: int) -> Values:
    """Return coverage as foam of a width (standard deviation, in cells) passes it on.

    As `tactile_graph_pads.contact.spread` does: each element takes what falls on its cell, and
    nothing leaves the pad of ``rows`` x ``columns``. The window must reach 3.5 widths further than
    the outline.
    """
    found = passed_on(shares, width, box, rows, columns)
    for i in range(found.shape[0]):
        for j in range(found.shape[1]):
            if found[i, j] < FAINT:
                found[i, j] = 0.0
    return found


@compiled_as_is
def foam_weights(width: float, most: int) -> Values:
    """Return the shares of a load that foam passes on 0, 1, 2, … cells, ``most``, along an axis."""
    reach = min(math.ceil(min(FOAM_REACH * width, most)) + 1, most)
    weights = np.empty(reach + 1)
    for k in range(reach + 1):
        far = 0.5 * math.erfc(-(k + 0.5) / width * SQRT_HALF)
        weights[k] = far - 0.5 * math.erfc(-(k - 0.5) / width * SQRT_HALF)
    return weights


@compiled_as_is
def passed_on(values: Values, width: float, box: Box, rows: int, columns: int) -> Values:
    """Return the same of any values, the faintest too."""
    weights = foam_weights(width, max(rows, columns))
    turned = _blurred_down(values, weights, box[0], rows)
    return _blurred_down(turned.T.copy(), weights, box[1], columns).T.copy()


@compiled_as_is
def _blurred_down(shares: Values, weights: Values, first: int, size: int) -> Values:
    """Blur along the first axis; weights of a source add up to 1 on a pad of ``size`` lines."""
    lines, across = shares.shape
    reach = weights.shape[0] - 1
    out = np.zeros((lines, across))
    for i in range(lines):
        bare = True
        for j in range(across):
            bare = bare and shares[i, j] == 0.0
        if bare:
            continue
        kept = 0.0
        for k in range(-reach, reach + 1):
            if 0 <= first + i + k < size:
                kept += weights[abs(k)]
        for k in range(-reach, reach + 1):
            if 0 <= i + k < lines:
                weight = weights[abs(k)] / kept
                for j in range(across):
                    out[i + k, j] += weight * shares[i, j]
    return out


@compiled_as_is
def foam_margin(grid: Values, noise: Values) -> float:
    """Return how far, in cm, foam carries load beyond an outline."""
    foam = (FOAM_REACH * noise[FOAM] + 2.0) * grid[2] if noise[FOAM] > 0.0 else 0.0
    margin: float = foam + grid[5]
    return margin


@compiled_as_is
def shares_of(
    kind: int, corners: int, p: Values, grid: Values, noise: Values, box: Box, rows: int,
    columns: int,
) -> Values:  # fmt: skip
    """Return coverage, weighed by the pressure and blurred by foam, shape (rows, columns) of a box.

    Parameters
    ----------
    kind, corners, p, grid, box
        As in `covered.covered`.
    noise : ndarray, shape (9,)
        As in `element_terms`; its foam, fall and lean.
    rows, columns : int
        Of the whole image.
    """
    shares = covered(kind, corners, p, grid, box)
    if not is_even(noise):
        press(kind, corners, p, grid, noise, box, shares)
    if noise[FOAM] > 0.0:
        shares = blurred(shares, noise[FOAM], box, rows, columns)
    return shares


@compiled_as_is
def shares_around(
    kind: int, corners: int, p: Values, grid: Values, noise: Values, shape: tuple[int, int]
) -> tuple[Box, Values]:
    """Return the window of elements that an outline may bring a load to, and `shares_of` there.

    The shares are of no rows where that is none of an image of a ``shape``.
    """
    rows, columns = shape
    box = window(kind, corners, p, grid, rows, columns, foam_margin(grid, noise))
    if box[2] <= 0 or box[3] <= 0:
        return box, np.empty((0, 0))
    return box, shares_of(kind, corners, p, grid, noise, box, rows, columns)
