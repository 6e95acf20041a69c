"""What a relief reads where it is pressed, its derivatives, and the fit of presses.

Lengths are in cells, loads and depths in what reads full scale. A relief is a depth at the nodes of
a grid around the object's middle. A press is six numbers: x, y, turn, how deep the foremost point
goes, and the lean along both axes of the object. At a point of the pad the load is what of the
press is deeper than the relief, as on a bed of springs; a cell takes the mean of its points,
blurred, and reads it by the pad's law. A box is row, column, rows and columns of the cells looked
at; a law the depth over which touching begins, power, threshold, where readings end, and the
variance of the lean.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tactile_graph.compiled import compiled_as_is

NODES = 3
"""Nodes of a relief along each side of a cell."""
POINTS = 3
"""Points of the pad along each side of a cell."""
HUBER = 3.0
"""Deviations beyond which a cell's misfit counts linearly."""


@compiled_as_is
def touched(relief: Any, press: Any, cos: Any, sin: Any, x: Any, y: Any, soft: Any) -> Any:
    """Return load, its slope by depth, the depth's slopes along u and v, u and v at a point."""
    n = relief.shape[0]
    half = (n - 1) / 2.0
    u = (x - press[0]) * cos + (y - press[1]) * sin
    v = (y - press[1]) * cos - (x - press[0]) * sin
    at_u, at_v = u * NODES + half, v * NODES + half
    if at_u < 0.0 or at_v < 0.0 or at_u >= n - 1 or at_v >= n - 1:
        return 0.0, 0.0, 0.0, 0.0, u, v
    i, j = int(at_v), int(at_u)
    q, p = at_v - i, at_u - j
    low, right = relief[i, j], relief[i, j + 1]
    up, both = relief[i + 1, j], relief[i + 1, j + 1]
    depth = (low * (1.0 - p) + right * p) * (1.0 - q) + (up * (1.0 - p) + both * p) * q
    over = press[3] - depth - press[4] * u - press[5] * v
    if over <= -soft:
        return 0.0, 0.0, 0.0, 0.0, u, v
    along_u = NODES * ((right - low) * (1.0 - q) + (both - up) * q) + press[4]
    along_v = NODES * ((up - low) * (1.0 - p) + (both - right) * p) + press[5]
    if over < soft:
        slope = (over + soft) / (2.0 * soft)
        return (over + soft) * slope / 2.0, slope, along_u, along_v, u, v
    return over, 1.0, along_u, along_v, u, v


@compiled_as_is
def points_of(start: Any, n: Any, n_pad: Any, reach: Any) -> Any:
    """Return the first and the last but one point that cells from ``start`` on take."""
    return max(0, start * POINTS - reach), min(n_pad * POINTS, (start + n) * POINTS + reach)


@compiled_as_is
def cells_of(point: Any, start: Any, n: Any, reach: Any) -> Any:
    """Return the first and the last but one of n cells from ``start`` on that take a point."""
    first = (point - reach - POINTS) // POINTS + 1 - start
    return max(0, first), min(n, (point + reach) // POINTS + 1 - start)


@compiled_as_is
def foremost_of(relief: Any) -> Any:
    """Return the least depth of what lies so many nodes, or more, from the middle."""
    n = relief.shape[0]
    half = (n - 1) // 2
    out = np.full(int(1.5 * half) + 3, np.inf)
    for i in range(n):
        for j in range(n):
            away = int(math.sqrt(float((i - half) * (i - half) + (j - half) * (j - half))))
            out[away] = min(out[away], relief[i, j])
    for k in range(out.size - 1):
        at = out.size - 2 - k
        out[at] = min(out[at], out[at + 1])
    return out


@compiled_as_is
def touching_radius(foremost: Any, press: Any, soft: Any) -> Any:
    """Return how many cells from the middle, at most, a press touches."""
    lean = math.sqrt(press[4] * press[4] + press[5] * press[5]) / NODES
    far = foremost.size - 1
    while far > 0 and foremost[far] >= press[3] + soft + lean * (far + 1):
        far -= 1
    return (far + 3.0) / NODES


@compiled_as_is
def chord(middle: Any, off: Any, radius: Any, start: Any, n: Any) -> Any:
    """Return the first and the last but one of n points from ``start`` on within a circle."""
    square = radius * radius - off * off
    if square <= 0.0:
        return 0, 0
    half = math.sqrt(square)
    first = int(max((middle - half) * POINTS - start - 1.5, 0.0))
    last = int(min(max((middle + half) * POINTS - start + 1.5, 0.0), float(n)))
    return first, last


@compiled_as_is
def loads(
    relief: Any, foremost: Any, press: Any, box: Any, rows: Any, columns: Any, taps: Any,
    soft: Any, wanted: Any,
) -> Any:  # fmt: skip
    """Return the load of the cells of a box, and where wanted its six derivatives, (m, h, w)."""
    n_rows, n_columns = box[2], box[3]
    reach = (taps.size - POINTS) // 2
    top, bottom = points_of(box[0], n_rows, rows, reach)
    left, right = points_of(box[1], n_columns, columns, reach)
    m = 7 if wanted else 1
    n = right - left
    out = np.zeros((m, n_rows, n_columns))
    line, tall = np.zeros((m, n)), np.zeros((m, n_rows, n))
    leftmost, rightmost = n, 0
    cos, sin = math.cos(press[2]), math.sin(press[2])
    radius = touching_radius(foremost, press, soft)
    for i in range(top, bottom):
        begin, end = n, 0
        from_j, to_j = chord(press[0], (i + 0.5) / POINTS - press[1], radius, left, n)
        for j in range(from_j, to_j):
            load, slope, du, dv, u, v = touched(
                relief, press, cos, sin, (left + j + 0.5) / POINTS, (i + 0.5) / POINTS, soft
            )
            if slope > 0.0:
                begin, end = min(begin, j), j + 1
            line[0, j] = load
            if wanted:
                line[1, j] = slope * (du * cos - dv * sin)
                line[2, j] = slope * (du * sin + dv * cos)
                line[3, j] = slope * (dv * u - du * v)
                line[4, j] = slope
                line[5, j] = -slope * u
                line[6, j] = -slope * v
        if end == 0:
            continue
        leftmost, rightmost = min(leftmost, begin), max(rightmost, end)
        first, last = cells_of(i, box[0], n_rows, reach)
        for r in range(first, last):
            tap = taps[i - (box[0] + r) * POINTS + reach]
            for k in range(m):
                for j in range(begin, end):
                    tall[k, r, j] += tap * line[k, j]
    for j in range(leftmost, rightmost):
        first, last = cells_of(left + j, box[1], n_columns, reach)
        for c in range(first, last):
            tap = taps[left + j - (box[1] + c) * POINTS + reach]
            for k in range(m):
                for r in range(n_rows):
                    out[k, r, c] += tap * tall[k, r, j]
    return out


@compiled_as_is
def read(load: Any, power: Any) -> Any:
    """Return what a load reads, and the slope."""
    if load <= 0.0:
        return 0.0, 0.0
    if load < 1e-3:
        slope = 1e-3 ** (power - 1.0)
        return load * slope, slope
    value = load**power
    return value, power * value / load


@compiled_as_is
def misfit(value: Any, seen: Any, weight: Any, top: Any) -> Any:
    """Return twice the cost of a cell, its weight in least squares and how far it is off."""
    off = value - seen
    if seen >= top and off > 0.0:
        return 0.0, 0.0, 0.0
    square = off * off * weight
    if square > HUBER * HUBER:
        deviations = math.sqrt(square)
        return HUBER * (2.0 * deviations - HUBER), weight * HUBER / deviations, off
    return square, weight, off


@compiled_as_is
def expected(relief: Any, press: Any, box: Any, gains: Any, taps: Any, law: Any) -> Any:
    """Return what the cells of a box read."""
    rows, columns = gains.shape[0], gains.shape[1]
    foremost = foremost_of(relief)
    load = loads(relief, foremost, press, box, rows, columns, taps, law[0], False)[0]
    for r in range(box[2]):
        for c in range(box[3]):
            load[r, c] = read(load[r, c] * gains[box[0] + r, box[1] + c] - law[2], law[1])[0]
    return load


@compiled_as_is
def solved(A: Any, b: Any) -> Any:
    """Return x of A x = b, A positive definite; all zeros if it is not."""
    n = b.size
    L, x = np.zeros((n, n)), np.zeros(n)
    for i in range(n):
        for j in range(i + 1):
            total = A[i, j]
            for k in range(j):
                total -= L[i, k] * L[j, k]
            if i == j:
                if not total > 0.0:
                    return x
                L[i, i] = math.sqrt(total)
            else:
                L[i, j] = total / L[j, j]
    for i in range(n):
        total = b[i]
        for k in range(i):
            total -= L[i, k] * x[k]
        x[i] = total / L[i, i]
    for m in range(n):
        i = n - 1 - m
        total = x[i]
        for k in range(i + 1, n):
            total -= L[k, i] * x[k]
        x[i] = total / L[i, i]
    return x


@compiled_as_is
def fitted(
    relief: Any, press: Any, seen: Any, weights: Any, box: Any, gains: Any, taps: Any, law: Any,
    n_steps: Any,
) -> Any:  # fmt: skip
    """Return the least misfit that steps of Levenberg and Marquardt from a press find, and where.

    Twice the cost of the cells, and the squares of the lean over its variance.
    """
    rows, columns = gains.shape[0], gains.shape[1]
    foremost = foremost_of(relief)
    best, found = 1e300, press.copy()
    at = press.copy()
    kept_A, kept_g = np.zeros((6, 6)), np.zeros(6)
    damping = 1e-2
    for _ in range(n_steps + 1):
        load = loads(relief, foremost, at, box, rows, columns, taps, law[0], True)
        A, g = np.zeros((6, 6)), np.zeros(6)
        cost = 0.0
        for r in range(box[2]):
            for c in range(box[3]):
                i, j = box[0] + r, box[1] + c
                value, slope = read(load[0, r, c] * gains[i, j] - law[2], law[1])
                twice, weight, off = misfit(value, seen[i, j], weights[i, j], law[3])
                cost += twice
                slope *= gains[i, j]
                if slope == 0.0 or weight == 0.0:
                    continue
                for k in range(6):
                    d = load[k + 1, r, c] * slope * weight
                    g[k] += d * off
                    for m in range(k + 1):
                        A[k, m] += d * load[m + 1, r, c] * slope
        for k in range(4, 6):
            cost += at[k] * at[k] / law[4]
            g[k] += at[k] / law[4]
            A[k, k] += 1.0 / law[4]
        if cost < best:
            gained = best - cost
            best, kept_A, kept_g = cost, A, g
            found[:] = at
            damping = max(damping * 0.2, 1e-5)
            if gained < 0.01:
                break
        else:
            damping *= 6.0
            if damping > 1e3:
                break
        B = kept_A.copy()
        for k in range(6):
            B[k, k] = B[k, k] * (1.0 + damping) + 1e-9
        step = solved(B, kept_g)
        size = max(max(abs(step[0]), abs(step[1])), max(abs(step[2]) / 0.4, 1.0))
        at = found - step / size
    return best, found


@compiled_as_is
def cost_of_all(
    relief: Any, presses: Any, seen: Any, weights: Any, boxes: Any, gains: Any, taps: Any,
    law: Any, by_node: Any, by_number: Any,
) -> Any:  # fmt: skip
    """Return the cost of an object's presses; write its gradient by relief and presses."""
    n = relief.shape[0]
    half = (n - 1) / 2.0
    reach = (taps.size - POINTS) // 2
    rows, columns = gains.shape[0], gains.shape[1]
    foremost = foremost_of(relief)
    cost = 0.0
    by_node[:] = 0.0
    by_number[:] = 0.0
    for s in range(presses.shape[0]):
        press, box = presses[s], boxes[s]
        n_rows, n_columns = box[2], box[3]
        load = loads(relief, foremost, press, box, rows, columns, taps, law[0], False)[0]
        radius = touching_radius(foremost, press, law[0])
        top, bottom = points_of(box[0], n_rows, rows, reach)
        left, right = points_of(box[1], n_columns, columns, reach)
        pulls = np.zeros((n_rows, n_columns))
        for r in range(n_rows):
            for c in range(n_columns):
                i, j = box[0] + r, box[1] + c
                value, slope = read(load[r, c] * gains[i, j] - law[2], law[1])
                twice, weight, off = misfit(value, seen[s, i, j], weights[s, i, j], law[3])
                cost += 0.5 * twice
                pulls[r, c] = weight * off * slope * gains[i, j]
        tall = np.zeros((n_rows, right - left))
        for j in range(right - left):
            first, last = cells_of(left + j, box[1], n_columns, reach)
            for c in range(first, last):
                tap = taps[left + j - (box[1] + c) * POINTS + reach]
                for r in range(n_rows):
                    tall[r, j] += tap * pulls[r, c]
        for k in range(4, 6):
            cost += 0.5 * press[k] * press[k] / law[4]
            by_number[s, k] += press[k] / law[4]
        cos, sin = math.cos(press[2]), math.sin(press[2])
        line = np.zeros(right - left)
        for i in range(top, bottom):
            y = (i + 0.5) / POINTS
            from_j, to_j = chord(press[0], y - press[1], radius, left, right - left)
            if to_j <= from_j:
                continue
            line[from_j:to_j] = 0.0
            first, last = cells_of(i, box[0], n_rows, reach)
            for r in range(first, last):
                tap = taps[i - (box[0] + r) * POINTS + reach]
                for j in range(from_j, to_j):
                    line[j] += tap * tall[r, j]
            for j in range(from_j, to_j):
                if line[j] == 0.0:
                    continue
                x = (left + j + 0.5) / POINTS
                _, slope, du, dv, u, v = touched(relief, press, cos, sin, x, y, law[0])
                if slope == 0.0:
                    continue
                pull = slope * line[j]
                at_u, at_v = u * NODES + half, v * NODES + half
                a, b = int(at_v), int(at_u)
                q, p = at_v - a, at_u - b
                by_node[a, b] -= pull * (1.0 - p) * (1.0 - q)
                by_node[a, b + 1] -= pull * p * (1.0 - q)
                by_node[a + 1, b] -= pull * (1.0 - p) * q
                by_node[a + 1, b + 1] -= pull * p * q
                by_number[s, 0] += pull * (du * cos - dv * sin)
                by_number[s, 1] += pull * (du * sin + dv * cos)
                by_number[s, 2] += pull * (dv * u - du * v)
                by_number[s, 3] += pull
                by_number[s, 4] -= pull * u
                by_number[s, 5] -= pull * v
    return cost


@compiled_as_is
def likeness(
    picture: Any, seen: Any, box: Any, turns: Any, shifts: Any, centre: Any, stride: Any
) -> Any:
    """Return for each turn the correlation with a picture of the object, and where it is best."""
    n = picture.shape[0]
    middle = (n - 1) / 2.0 + 0.5
    out = np.full((turns.size, 3), -1.0)
    bb = 1e-30
    for i in range(box[0], box[0] + box[2], stride):
        for j in range(box[1], box[1] + box[3], stride):
            bb += seen[i, j] * seen[i, j]
    for t in range(turns.size):
        cos, sin = NODES * math.cos(turns[t]), NODES * math.sin(turns[t])
        for along in range(shifts.size):
            for down in range(shifts.size):
                x0, y0 = centre[0] + shifts[along], centre[1] + shifts[down]
                aa, ab = 1e-30, 0.0
                for i in range(box[0], box[0] + box[2], stride):
                    y = i + 0.5 - y0
                    u0, v0 = y * sin + middle, y * cos + middle
                    for j in range(box[1], box[1] + box[3], stride):
                        x = j + 0.5 - x0
                        u, v = u0 + x * cos, v0 - x * sin
                        if u >= 0.5 and u < n - 0.5 and v >= 0.5 and v < n - 0.5:
                            a = picture[int(v), int(u)]
                            aa += a * a
                            ab += a * seen[i, j]
                alike = ab / math.sqrt(aa * bb)
                if alike > out[t, 0]:
                    out[t, 0], out[t, 1], out[t, 2] = alike, x0, y0
    return out


@compiled_as_is
def add_picture(total: Any, weight: Any, seen: Any, press: Any, share: Any) -> None:
    """Add a press's readings, in the object's coordinates and times a share, to a picture."""
    n = total.shape[0]
    half = (n - 1) / 2.0
    cos, sin = math.cos(press[2]), math.sin(press[2])
    n_rows, n_columns = seen.shape
    for a in range(n):
        for b in range(n):
            u, v = (b - half) / NODES, (a - half) / NODES
            x, y = press[0] + u * cos - v * sin - 0.5, press[1] + u * sin + v * cos - 0.5
            if x < -0.5 or y < -0.5 or x > n_columns - 0.5 or y > n_rows - 0.5:
                continue
            x, y = min(max(x, 0.0), n_columns - 1.001), min(max(y, 0.0), n_rows - 1.001)
            i, j = int(y), int(x)
            q, p = y - i, x - j
            upper = seen[i, j] * (1.0 - p) + seen[i, j + 1] * p
            lower = seen[i + 1, j] * (1.0 - p) + seen[i + 1, j + 1] * p
            total[a, b] += share * (upper * (1.0 - q) + lower * q)
            weight[a, b] += share
