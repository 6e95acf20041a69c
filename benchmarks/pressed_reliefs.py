"""The kernels of `learned_reliefs`: what a relief reads where it is pressed, and its derivatives.

Lengths are in cells, loads and depths in what reads full scale. A relief is a depth at the nodes of
a grid around the object's middle. A press is six numbers: x, y, turn, how deep the foremost point
goes, and the lean along both axes of the object. At a point of the pad the load is what of the
press is deeper than the relief; a cell takes the mean of its points, blurred, and reads it by the
pad's law.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

NODES = 3
"""Nodes of a relief along each side of a cell."""
POINTS = 3
"""Points of the pad along each side of a cell."""
HUBER = 3.0
"""Deviations beyond which a cell's misfit counts linearly."""
OPTIONS = {"cache": True, "fastmath": True, "nogil": True}


@njit(**OPTIONS)
def touched(relief, press, x, y, soft):
    """Return load, its slope by depth, the depth's slopes along u and v, u and v at a point."""
    n = relief.shape[0]
    half = (n - 1) / 2.0
    cos, sin = math.cos(press[2]), math.sin(press[2])
    u = (x - press[0]) * cos + (y - press[1]) * sin
    v = (y - press[1]) * cos - (x - press[0]) * sin
    at_u, at_v = u * NODES + half, v * NODES + half
    if at_u < 0.0 or at_v < 0.0 or at_u >= n - 1 or at_v >= n - 1:
        return 0.0, 0.0, 0.0, 0.0, u, v
    i, j = int(at_v), int(at_u)
    q, p = at_v - i, at_u - j
    low, right = relief[i, j], relief[i, j + 1]
    up, both = relief[i + 1, j], relief[i + 1, j + 1]
    depth = (low * (1 - p) + right * p) * (1 - q) + (up * (1 - p) + both * p) * q
    over = press[3] - depth - press[4] * u - press[5] * v
    if over <= -soft:
        return 0.0, 0.0, 0.0, 0.0, u, v
    along_u = NODES * ((right - low) * (1 - q) + (both - up) * q) + press[4]
    along_v = NODES * ((up - low) * (1 - p) + (both - right) * p) + press[5]
    if over < soft:
        slope = (over + soft) / (2.0 * soft)
        return (over + soft) * slope / 2.0, slope, along_u, along_v, u, v
    return over, 1.0, along_u, along_v, u, v


@njit(**OPTIONS)
def by_press(slope, along_u, along_v, u, v, press, out):
    """Write a load's derivatives by the six numbers of the press."""
    cos, sin = math.cos(press[2]), math.sin(press[2])
    out[0] = slope * (along_u * cos - along_v * sin)
    out[1] = slope * (along_u * sin + along_v * cos)
    out[2] = slope * (along_v * u - along_u * v)
    out[3] = slope
    out[4] = -slope * u
    out[5] = -slope * v


@njit(**OPTIONS)
def points_of(start, n, n_pad, reach):
    """Return the first and last but one point that cells from start on take."""
    return max(0, start * POINTS - reach), min(n_pad * POINTS, (start + n) * POINTS + reach)


@njit(**OPTIONS)
def loads(relief, press, box, shape, taps, soft, wanted):
    """Return the load of the cells of a box, and where wanted its six derivatives."""
    n_rows, n_columns = box[2], box[3]
    reach = (taps.size - POINTS) // 2
    top, bottom = points_of(box[0], n_rows, shape[0], reach)
    left, right = points_of(box[1], n_columns, shape[1], reach)
    m = 7 if wanted else 1
    out = np.zeros((m, n_rows, n_columns))
    line = np.zeros((m, right - left))
    slopes = np.zeros(6)
    blurred = np.zeros((m, n_columns))
    for i in range(top, bottom):
        line[:] = 0.0
        any_load = False
        for j in range(left, right):
            load, slope, du, dv, u, v = touched(
                relief, press, (j + 0.5) / POINTS, (i + 0.5) / POINTS, soft
            )
            if slope > 0.0:
                any_load = True
                line[0, j - left] = load
                if wanted:
                    by_press(slope, du, dv, u, v, press, slopes)
                    for k in range(6):
                        line[k + 1, j - left] = slopes[k]
        if not any_load:
            continue
        for c in range(n_columns):
            first = (box[1] + c) * POINTS - reach - left
            for k in range(m):
                total = 0.0
                for t in range(max(0, -first), min(taps.size, right - left - first)):
                    total += taps[t] * line[k, first + t]
                blurred[k, c] = total
        for r in range(n_rows):
            t = i - (box[0] + r) * POINTS + reach
            if 0 <= t < taps.size:
                for k in range(m):
                    for c in range(n_columns):
                        out[k, r, c] += taps[t] * blurred[k, c]
    return out


@njit(**OPTIONS)
def read(load, law):
    """Return what a load reads, and the slope."""
    if load <= 0.0:
        return 0.0, 0.0
    if load < 1e-3:
        slope = 1e-3 ** (law - 1.0)
        return load * slope, slope
    value = load**law
    return value, law * value / load


@njit(**OPTIONS)
def misfit(value, slope, seen, weight, top):
    """Return twice the cost of a cell, its weight in least squares and how far it is off."""
    off = value - seen
    if seen >= top and off > 0.0:
        return 0.0, 0.0, 0.0
    square = off * off * weight
    if square > HUBER * HUBER:
        deviations = math.sqrt(square)
        return HUBER * (2.0 * deviations - HUBER), weight * HUBER / deviations, off
    return square, weight, off


@njit(**OPTIONS)
def expected(relief, press, box, gains, taps, law):
    """Return what the cells of a box read; law: softness, power, threshold, top, lean."""
    load = loads(relief, press, box, gains.shape, taps, law[0], False)[0]
    for r in range(box[2]):
        for c in range(box[3]):
            load[r, c] = read(load[r, c] * gains[box[0] + r, box[1] + c] - law[2], law[1])[0]
    return load


@njit(**OPTIONS)
def fitted(relief, press, seen, weights, box, gains, taps, law, n_steps):
    """Return the least misfit that steps of Levenberg and Marquardt from a press find, and where.

    Twice the cost of the cells, and the squares of the lean over its variance (``law[4]``).
    """
    best, found = 1e300, press.copy()
    at = press.copy()
    kept_A, kept_g = np.zeros((6, 6)), np.zeros(6)
    damping = 1e-2
    for _ in range(n_steps + 1):
        load = loads(relief, at, box, gains.shape, taps, law[0], True)
        A, g = np.zeros((6, 6)), np.zeros(6)
        cost = 0.0
        for r in range(box[2]):
            for c in range(box[3]):
                i, j = box[0] + r, box[1] + c
                value, slope = read(load[0, r, c] * gains[i, j] - law[2], law[1])
                twice, weight, off = misfit(value, slope, seen[i, j], weights[i, j], law[3])
                cost += twice
                slope *= gains[i, j]
                if slope == 0.0 or weight == 0.0:
                    continue
                for k in range(6):
                    d = load[k + 1, r, c] * slope * weight
                    g[k] += d * off
                    for m in range(k + 1):
                        A[k, m] += d * load[m + 1, r, c] * slope
        for k in (4, 5):
            cost += at[k] ** 2 / law[4]
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
        B = kept_A + np.tril(kept_A, -1).T
        for k in range(6):
            B[k, k] = B[k, k] * (1.0 + damping) + 1e-9
        step = np.linalg.solve(B, kept_g)
        size = max(abs(step[0]), abs(step[1]), abs(step[2]) / 0.4, 1.0)
        at = found - step / size
    return best, found


@njit(**OPTIONS)
def cost_of_all(relief, presses, seen, weights, boxes, gains, taps, law, by_node, by_number):
    """Return the cost of an object's presses; write its gradient by relief and presses."""
    n = relief.shape[0]
    half = (n - 1) / 2.0
    reach = (taps.size - POINTS) // 2
    cost = 0.0
    by_node[:] = 0.0
    by_number[:] = 0.0
    slopes = np.zeros(6)
    for s in range(presses.shape[0]):
        press, box = presses[s], boxes[s]
        load = loads(relief, press, box, gains.shape, taps, law[0], False)[0]
        top, bottom = points_of(box[0], box[2], gains.shape[0], reach)
        left, right = points_of(box[1], box[3], gains.shape[1], reach)
        down = np.zeros((bottom - top, box[3]))
        for r in range(box[2]):
            for c in range(box[3]):
                i, j = box[0] + r, box[1] + c
                value, slope = read(load[r, c] * gains[i, j] - law[2], law[1])
                twice, weight, off = misfit(value, slope, seen[s, i, j], weights[s, i, j], law[3])
                cost += 0.5 * twice
                pull = weight * off * slope * gains[i, j]
                if pull != 0.0:
                    first = i * POINTS - reach - top
                    for t in range(max(0, -first), min(taps.size, bottom - top - first)):
                        down[first + t, c] += taps[t] * pull
        for k in (4, 5):
            cost += 0.5 * press[k] ** 2 / law[4]
            by_number[s, k] += press[k] / law[4]
        line = np.zeros(right - left)
        for i in range(bottom - top):
            line[:] = 0.0
            for c in range(box[3]):
                if down[i, c] != 0.0:
                    first = (box[1] + c) * POINTS - reach - left
                    for t in range(max(0, -first), min(taps.size, right - left - first)):
                        line[first + t] += taps[t] * down[i, c]
            for j in range(right - left):
                if line[j] == 0.0:
                    continue
                x, y = (left + j + 0.5) / POINTS, (top + i + 0.5) / POINTS
                _, slope, du, dv, u, v = touched(relief, press, x, y, law[0])
                if slope == 0.0:
                    continue
                pull = slope * line[j]
                at_u, at_v = u * NODES + half, v * NODES + half
                a, b = int(at_v), int(at_u)
                q, p = at_v - a, at_u - b
                by_node[a, b] -= pull * (1 - p) * (1 - q)
                by_node[a, b + 1] -= pull * p * (1 - q)
                by_node[a + 1, b] -= pull * (1 - p) * q
                by_node[a + 1, b + 1] -= pull * p * q
                by_press(pull, du, dv, u, v, press, slopes)
                for k in range(6):
                    by_number[s, k] += slopes[k]
    return cost


@njit(**OPTIONS)
def likeness(picture, seen, box, turns, shifts, centre, stride):
    """Return for each turn the correlation with a picture of the object, and where it is best."""
    n = picture.shape[0]
    half = (n - 1) / 2.0
    out = np.full((turns.size, 3), -1.0)
    for t in range(turns.size):
        cos, sin = math.cos(turns[t]), math.sin(turns[t])
        for shift_x in shifts:
            for shift_y in shifts:
                x0, y0 = centre[0] + shift_x, centre[1] + shift_y
                aa, ab, bb = 1e-30, 0.0, 1e-30
                for i in range(box[0], box[0] + box[2], stride):
                    for j in range(box[1], box[1] + box[3], stride):
                        b = seen[i, j]
                        bb += b * b
                        x, y = j + 0.5 - x0, i + 0.5 - y0
                        u = (x * cos + y * sin) * NODES + half
                        v = (y * cos - x * sin) * NODES + half
                        if 0 <= u < n - 1 and 0 <= v < n - 1:
                            a = picture[int(v + 0.5), int(u + 0.5)]
                            aa += a * a
                            ab += a * b
                alike = ab / math.sqrt(aa * bb)
                if alike > out[t, 0]:
                    out[t, 0], out[t, 1], out[t, 2] = alike, x0, y0
    return out


@njit(**OPTIONS)
def add_picture(total, weight, seen, press, share):
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
            upper = seen[i, j] * (1 - p) + seen[i, j + 1] * p
            lower = seen[i + 1, j] * (1 - p) + seen[i + 1, j + 1] * p
            total[a, b] += share * (upper * (1 - q) + lower * q)
            weight[a, b] += share
