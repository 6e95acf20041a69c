"""What kernels of tactile_graph_fitters are held against: the same answers, vectorised."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from tactile_graph_fitters.circle.algebraic import Moments
from tactile_graph_fitters.circle.geometric import Slopes
from tactile_graph_fitters.circle.principal_axes import (
    ALL_EQUAL,
    LARGEST,
    NOT_FINITE,
    OK,
    OUT_OF_RANGE,
    SMALLEST,
    TOO_FEW,
)
from tactile_graph_fitters.orientation.orientation import Sums
from tactile_graph_fitters.orientation.rotate_mask import Rotated
from tactile_graph_fitters.rectangle.rectangle_likelihood import (
    DENSITY,
    OFF,
    ON,
    SQRT_HALF,
    States,
    Values,
)


def cost(
    p: Values, logs: Values, states: States, xs: Values, ys: Values, law: Values, slope: Values
) -> float:
    """Return the cost of a rectangle; write its gradient into ``slope``."""
    sigma, voids, full, stray, width, use = law.tolist()
    x, y, half, other, angle = p.tolist()
    cos, sin = math.cos(angle), math.sin(angle)
    dx, dy = xs[None, :] - x, y - ys[:, None]
    u, v = dx * cos + dy * sin, dy * cos - dx * sin
    along = np.clip(0.5 + (half - np.abs(u)) / width, 0.0, 1.0)
    across = np.clip(0.5 + (other - np.abs(v)) / width, 0.0, 1.0)
    covered = along * across
    known = np.log(covered, out=np.full(covered.shape, -np.inf), where=covered > 0.0)
    safe = np.where(covered > 0.0, covered, 1.0)
    z = (known + full) / sigma
    tail = np.array([[0.5 * math.erfc(-SQRT_HALF * e) for e in row] for row in z.tolist()])
    density = DENSITY * np.exp(-0.5 * z * z)
    if use > 0.0:
        d = (logs - known) / sigma
        likely = np.exp(-0.5 * d * d)
        d_likely = likely * np.where(covered > 0.0, d, 0.0) / (sigma * safe)
    else:
        likely, d_likely = (1.0 - voids) * tail, (1.0 - voids) * density / (sigma * safe)
    bare = 1.0 - (1.0 - voids) * tail
    on, off = states == ON, states == OFF
    total = -np.log(np.where(on, likely + stray, np.where(off, bare, 1.0))).sum()
    d_cost = np.where(
        on,
        -d_likely / (likely + stray),
        np.where(off, (1.0 - voids) * density / (sigma * safe) / bare, 0.0),
    )
    d_cost[covered <= 0.0] = 0.0
    g_along = d_cost * across / width * (along < 1.0)
    g_across = d_cost * along / width * (across < 1.0)
    g_u, g_v = -g_along * np.sign(u), -g_across * np.sign(v)
    slope[0] = (g_v * sin - g_u * cos).sum()
    slope[1] = (g_u * sin + g_v * cos).sum()
    slope[2], slope[3] = g_along.sum(), g_across.sum()
    slope[4] = (g_u * v - g_v * u).sum()
    return float(total)


def reduced(
    uv: Values, ellipse: Values, cs: Values, rows: Values, normal: Values, slope: Values
) -> float:
    """Write Newton's equations for the ellipse alone; return the sum of squares."""
    (c, s), m = cs, ellipse[[2, 3, 3, 4]].reshape(2, 2)
    one, none = np.ones_like(c), np.zeros_like(c)
    on, along = m @ cs, m @ np.array([-s, c])
    off = uv - ellipse[:2, None] - on
    speed, inward = (along * along).sum(axis=0), (off * on).sum(axis=0)
    if not (speed + inward > 0.0).all():
        return math.inf
    by_ellipse = np.array([[one, none, c, s, none], [none, one, none, c, s]])
    by_both = np.array([[none, none, -s, c, none], [none, none, none, -s, c]])
    shifts = np.einsum("akn,an->kn", by_ellipse, along)
    turns = np.einsum("akn,an->kn", by_both, off)
    rows[:5], rows[5] = shifts - turns, 1.0 / (speed + inward)
    rows[6] = -(off * along).sum(axis=0) * rows[5]
    normal[:] = np.einsum("akn,aln->kl", by_ellipse, by_ellipse) - (rows[:5] * rows[5]) @ rows[:5].T
    # Along the normal; and the rest, which is all rounding at the end and nearly cancels.
    outward = np.array([along[1], -along[0]])
    distance = (off * outward).sum(axis=0) / speed
    slope[:] = (shifts * inward / speed + turns) @ rows[6]
    slope -= np.einsum("akn,an->k", by_ellipse, outward * distance)
    return float((off * off).sum())


def bounds(xy: NDArray[np.float64]) -> tuple[int, float, float, float, float]:
    """Return a status, the middle (x, y) of the points, half their extent, their largest size."""
    if len(xy) < 3:
        return TOO_FEW, 0.0, 0.0, 0.0, 0.0
    largest = float(np.abs(xy).max())
    if not math.isfinite(largest):
        return NOT_FINITE, 0.0, 0.0, 0.0, 0.0
    if largest > LARGEST or 0.0 < largest < SMALLEST:
        return OUT_OF_RANGE, 0.0, 0.0, 0.0, 0.0
    low, high = xy.min(axis=0), xy.max(axis=0)
    half = float((high - low).max()) / 2.0
    status = OK if half > 0.0 else ALL_EQUAL
    return status, float(low[0] + high[0]) / 2.0, float(low[1] + high[1]) / 2.0, half, largest


def turned(
    xy: NDArray[np.float64], x: float, y: float, half: float
) -> tuple[NDArray[np.float64], float, float, float, float]:
    """Return the points along (u) and across (v) their main axis; their mean; cosine and sine."""
    p = (xy - (x, y)) / half
    mean = p.mean(axis=0)
    p -= mean
    (xx, xy_), (_, yy) = p.T @ p
    angle = 0.5 * math.atan2(2.0 * xy_, xx - yy)
    cos, sin = math.cos(angle), math.sin(angle)
    uv = np.vstack([p[:, 0] * cos + p[:, 1] * sin, p[:, 1] * cos - p[:, 0] * sin])
    return uv, float(mean[0]), float(mean[1]), cos, sin


def slopes(uv: NDArray[np.float64], a: float, b: float) -> Slopes:
    """Return what the sum of squares F does around the centre (a, b), per point."""
    u, v = uv
    du, dv = u - a, v - b
    d = np.hypot(du, dv)
    centre = math.hypot(a, b)
    inverse = np.divide(1.0, d, out=np.zeros_like(d), where=d > 0.0)
    beyond = u * u + v * v - 2.0 * (a * u + b * v)  # = d**2 - centre**2
    size = d + centre
    off = np.divide(beyond, size, out=np.zeros_like(d), where=size > 0.0)
    # Gradient of d, and what it differs by from that at the points' middle: so few digits of the
    # sine itself say how a slight arc is bent.
    cos, sin = -du * inverse, -dv * inverse
    to_a, to_b = (a / centre, b / centre) if centre > 0.0 else (0.0, 0.0)
    cos_off, sin_off = -(u + to_a * off) * inverse, -(v + to_b * off) * inverse
    cos_off -= cos_off.mean()
    sin_off -= sin_off.mean()
    mean = off.mean()
    off -= mean
    bend = off * inverse
    return (
        float(centre + mean),
        float((off * off).mean()),
        float((off * cos_off).mean()),
        float((off * sin_off).mean()),
        float((cos_off * cos_off).mean()),
        float((cos_off * sin_off).mean()),
        float((sin_off * sin_off).mean()),
        float((bend * sin * sin).mean()),
        float((-bend * cos * sin).mean()),
        float((bend * cos * cos).mean()),
    )


def iterated(
    uv: NDArray[np.float64], max_iterations: int, tolerance: float
) -> tuple[bool, float, float, float, int]:
    """Return whether it settled, centre (u, v), radius and rounds made."""
    u, v = uv
    x = y = 0.0  # the points are centred: their centroid
    radius = float(np.hypot(u, v).mean())
    for rounds in range(1, max_iterations + 1):
        du, dv = x - u, y - v
        d = np.hypot(du, dv)
        inverse = np.divide(1.0, d, out=np.zeros_like(d), where=d > 0.0)
        new_x = radius * float((du * inverse).mean())  # B.8
        new_y = radius * float((dv * inverse).mean())  # B.9
        new_radius = float(d.mean())  # B.10
        change = max(abs(new_x - x), abs(new_y - y), abs(new_radius - radius))
        x, y, radius = new_x, new_y, new_radius
        if change <= tolerance * radius:
            return True, x, y, radius, rounds
    return False, x, y, radius, max_iterations


def moments(uv: NDArray[np.float64]) -> Moments:
    """Return the means of u u, v v, u w, v w and w w, where w is u u + v v less its mean."""
    u, v = uv
    z = u * u + v * v
    w = z - z.mean()
    return (
        float((u * u).mean()),
        float((v * v).mean()),
        float((u * w).mean()),
        float((v * w).mean()),
        float((w * w).mean()),
    )


def rotated(
    values: NDArray[np.bool_],
    column: float,
    row: float,
    cos: float,
    sin: float,
    width: float,
    height: float,
) -> Rotated:
    """Return the turned cells and the place of the first, in cells right and down of the centre."""
    rows, columns = np.nonzero(values)
    if len(rows) == 0:
        return np.zeros((0, 0), np.bool_), 0, 0
    dx, dy = (columns - column) * width, (rows - row) * height
    u = np.floor((dx * cos - dy * sin) + 0.5).astype(np.int64)
    v = np.floor((dx * sin + dy * cos) + 0.5).astype(np.int64)
    left, top = u.min(), v.min()
    out = np.zeros((v.max() - top + 1, u.max() - left + 1), np.bool_)
    out[v - top, u - left] = True
    return out, int(left), int(top)


def mask_scatter(values: NDArray[np.bool_]) -> Sums:
    """Return number, mean (column, row) and scatter of the cells that are on."""
    rows, columns = np.nonzero(values)
    return points_scatter(np.column_stack([columns, rows]).astype(np.float64))


def points_scatter(xy: NDArray[np.float64]) -> Sums:
    """Return number, mean (x, y) and scatter (xx, xy, yy) of points of shape (N, 2)."""
    n = len(xy)
    if n == 0:
        return 0, 0.0, 0.0, 0.0, 0.0, 0.0
    with np.errstate(invalid="ignore", over="ignore"):  # found out by what comes out
        middle = xy[0] + (xy - xy[0]).mean(axis=0)
        dx, dy = (xy - middle).T
        xx, xy_, yy = float((dx * dx).sum()), float((dx * dy).sum()), float((dy * dy).sum())
    return n, float(middle[0]), float(middle[1]), xx, xy_, yy
