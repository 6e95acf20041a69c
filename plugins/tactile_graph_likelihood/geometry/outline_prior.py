"""What is known of an outline before anything is read: proper, so that evidence compares.

Place uniform over the pad, lengths log-uniform over a range, angle uniform over a period, the
corners of a free polygon uniform over all convex polygons with as many.
"""

from __future__ import annotations

import math

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.outlines import (
    ELLIPSE,
    FREE,
    OVAL,
    Values,
    bounds,
    period,
    sizes,
)
from tactile_graph_likelihood.geometry.oval import as_ellipse, to_oval

LEFT, TOP, WIDTH, HEIGHT, SMALLEST, LARGEST, WHOLE, TURN, EXTRA = range(9)
"""Places in a prior vector: the pad's edges in cm; the range of half sizes and radii in cm; the
probability that the outline must lie on the pad; the angle about which a period is looked at, NaN
where it may be any; a constant to add."""


@compiled_as_is
def log_prior(kind: int, corners: int, p: Values, prior: Values) -> float:
    """Return the logarithm of an outline's prior density, -inf where it cannot be.

    Parameters
    ----------
    kind, corners, p : int, int, ndarray
        The outline, as in `outlines`; the density is per unit of each of its numbers.
    prior : ndarray, shape (9,)
        As named by `LEFT` and so on.

    Notes
    -----
    An oval's is that of half axes and angle: `oval.log_stretch` makes it one of its own numbers.
    As far as an outline is on the pad whole, by `WHOLE`, its centre is uniform over the room that
    the pad leaves it; as far as it need not be, over the pad. A free polygon's n
    corners are n uniform points of the pad, given that they are in convex position, which they
    are with the probability ``(C(2n-2, n-1) / n!)**2`` (P. Valtr 1995, 10.1007/BF02574070).
    """
    if kind == FREE:
        return _log_prior_free(corners, p, prior)
    total, turn = prior[EXTRA], period(kind, corners)
    if kind == OVAL:
        kind, p = ELLIPSE, as_ellipse(p)
        total -= math.log(0.5 * math.pi)
    n = sizes(kind)
    span = math.log(prior[LARGEST] / prior[SMALLEST])
    for k in range(2, 2 + n):
        if not prior[SMALLEST] <= p[k] <= prior[LARGEST]:
            return -math.inf
        total -= math.log(p[k] * span)
    if turn > 0.0:
        if abs(p[2 + n] - prior[TURN]) > 0.5 * turn:
            return -math.inf
        total -= math.log(turn)
    x, y, wide, high = p[0] - prior[LEFT], p[1] - prior[TOP], prior[WIDTH], prior[HEIGHT]
    chance = 0.0
    if 0.0 <= x <= wide and 0.0 <= y <= high:
        chance = (1.0 - prior[WHOLE]) / (wide * high)
    if prior[WHOLE] > 0.0:
        left, top, right, bottom = bounds(kind, corners, p)
        across, down = wide - (right - left), high - (bottom - top)
        on_pad = left >= prior[LEFT] and right <= prior[LEFT] + wide
        on_pad = on_pad and top >= prior[TOP] and bottom <= prior[TOP] + high
        if on_pad and across > 0.0 and down > 0.0:
            chance += prior[WHOLE] / (across * down)
    return total + math.log(chance) if chance > 0.0 else -math.inf


@compiled_as_is
def _log_prior_free(corners: int, p: Values, prior: Values) -> float:
    """Return the same for a free convex polygon; all its corners are on the pad."""
    for k in range(corners):
        a, b, c = 2 * k, 2 * ((k + 1) % corners), 2 * ((k + 2) % corners)
        cross = (p[b] - p[a]) * (p[c + 1] - p[b + 1]) - (p[b + 1] - p[a + 1]) * (p[c] - p[b])
        if cross <= 0.0:
            return -math.inf
        x, y = p[a] - prior[LEFT], p[a + 1] - prior[TOP]
        if not (0.0 <= x <= prior[WIDTH] and 0.0 <= y <= prior[HEIGHT]):
            return -math.inf
    log_factorial, log_choices = math.log(corners), 0.0
    for k in range(1, corners):
        log_factorial += math.log(k)
        log_choices += math.log((corners - 1 + k) / k)
    area = math.log(prior[WIDTH] * prior[HEIGHT])
    density: float = prior[EXTRA] + 3.0 * log_factorial - 2.0 * log_choices - corners * area
    return density


@compiled_as_is
def pulled_in(kind: int, corners: int, p: Values, prior: Values) -> None:
    """Bring an outline, in place, to where its prior is not zero, if a small push does it."""
    if kind == FREE:
        return
    at = p
    if kind == OVAL:
        at = as_ellipse(p)
    _pulled_in(ELLIPSE if kind == OVAL else kind, corners, at, prior)
    if kind == OVAL:
        to_oval(at)
        p[:] = at


@compiled_as_is
def _pulled_in(kind: int, corners: int, p: Values, prior: Values) -> None:
    """Do so for what is neither a free polygon nor an oval."""
    for k in range(2, 2 + sizes(kind)):
        p[k] = min(max(p[k], 1.001 * prior[SMALLEST]), 0.999 * prior[LARGEST])
    if prior[WHOLE] < 1.0:
        p[0] = min(max(p[0], prior[LEFT]), prior[LEFT] + prior[WIDTH])
        p[1] = min(max(p[1], prior[TOP]), prior[TOP] + prior[HEIGHT])
        return
    left, top, right, bottom = bounds(kind, corners, p)
    shrink = 0.999 * min(prior[WIDTH] / (right - left), prior[HEIGHT] / (bottom - top))
    if shrink < 1.0:
        for k in range(2, 2 + sizes(kind)):
            p[k] *= shrink
        left, top, right, bottom = bounds(kind, corners, p)
    tiny = 1e-9
    p[0] += max(0.0, prior[LEFT] + tiny - left) - max(
        0.0, right + tiny - prior[LEFT] - prior[WIDTH]
    )
    p[1] += max(0.0, prior[TOP] + tiny - top) - max(0.0, bottom + tiny - prior[TOP] - prior[HEIGHT])
