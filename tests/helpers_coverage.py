"""Overlaps of one rectangle with a shape, by other formulas than the product's."""

import math

import numpy as np


def _edge(ax, ay, bx, by):
    """Area between the origin and a segment, inside the unit circle."""
    dx, dy = bx - ax, by - ay
    a, b, c = dx * dx + dy * dy, ax * dx + ay * dy, ax * ax + ay * ay - 1.0
    if a == 0.0:
        return 0.0
    root = b * b - a * c

    def sector(px, py, qx, qy):
        return 0.5 * math.atan2(px * qy - py * qx, px * qx + py * qy)

    if root <= 0.0:
        return sector(ax, ay, bx, by)
    t0, t1 = (-b - math.sqrt(root)) / a, (-b + math.sqrt(root)) / a
    if t1 <= 0.0 or t0 >= 1.0:
        return sector(ax, ay, bx, by)
    t0, t1 = max(t0, 0.0), min(t1, 1.0)
    px, py, qx, qy = ax + t0 * dx, ay + t0 * dy, ax + t1 * dx, ay + t1 * dy
    return sector(ax, ay, px, py) + 0.5 * (px * qy - py * qx) + sector(qx, qy, bx, by)


def ellipse_on_rectangle(x, y, a, b, angle_rad, left, top, width, height):
    """Map the ellipse to the unit circle and add triangles and sectors of the mapped edges."""
    cos, sin = math.cos(angle_rad), math.sin(angle_rad)
    corners = [
        (left, top),
        (left + width, top),
        (left + width, top + height),
        (left, top + height),
    ]
    mapped = [
        (((px - x) * cos - (py - y) * sin) / a, ((px - x) * sin + (py - y) * cos) / b)
        for px, py in corners
    ]
    pairs = zip(mapped, mapped[1:] + mapped[:1], strict=True)
    return a * b * abs(sum(_edge(*p, *q) for p, q in pairs))


def polygon_area(corners):
    """Area by the shoelace formula."""
    xy = np.asarray(corners)
    if len(xy) < 3:
        return 0.0
    x, y = xy.T
    return 0.5 * abs(float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum()))


def polygon_on_rectangle(corners, left, top, width, height):
    """Cut a convex polygon by each side of the rectangle in turn (Sutherland, Hodgman)."""
    sides = [(0, 1, left), (0, -1, -(left + width)), (1, 1, top), (1, -1, -(top + height))]
    points = [tuple(p) for p in corners]
    for axis, sign, limit in sides:
        kept = []
        for p, q in zip(points, points[1:] + points[:1], strict=True):
            dp, dq = sign * p[axis] - limit, sign * q[axis] - limit
            if dp >= 0.0:
                kept.append(p)
            if dp * dq < 0.0:
                t = dp / (dp - dq)
                kept.append(tuple(u + t * (v - u) for u, v in zip(p, q, strict=True)))
        points = kept
    return polygon_area(points)


def on_grid(function, rows=16, columns=16, pitch=1.3, element=1.0):
    """One value per element of a grid."""
    return np.array(
        [
            [function(c * pitch, r * pitch, element, element) for c in range(columns)]
            for r in range(rows)
        ]
    )
