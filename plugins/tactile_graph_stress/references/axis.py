"""The main axis of points by their scatter matrix, to 50 digits."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph_stress.references.stationary import DIGITS, STEP, Solved


def main_axis(xy: NDArray[np.float64]) -> Solved | None:
    """Return mean x, y and the axis' angle in (x, y); None where every direction is as good."""
    from mpmath import atan2, hypot, mp, mpf

    def shape(points: list[tuple[Any, Any]]) -> list[Any]:
        n = len(points)
        x, y = (sum(p[k] for p in points) / n for k in (0, 1))
        xx, yy = (sum((p[k] - m) ** 2 for p in points) for k, m in ((0, x), (1, y)))
        xy_ = sum((p[0] - x) * (p[1] - y) for p in points)
        return [x, y, xx, xy_, yy]

    with mp.workdps(DIGITS):
        raw = [(mpf(float(x)), mpf(float(y))) for x, y in xy]
        x, y, xx, xy_, yy = shape(raw)
        split = hypot(xx - yy, 2 * xy_)
        if not split > mpf(STEP) * (xx + yy):
            return None
        angle = atan2(2 * xy_, xx - yy) / 2
        # d angle = ((xx - yy) d xy - xy d(xx - yy)) / split**2
        moves = [
            abs(2 * ((xx - yy) * (py - y) - 2 * xy_ * (px - x)))
            + abs(2 * ((xx - yy) * (px - x) + 2 * xy_ * (py - y)))
            for px, py in raw
        ]
        turning = sum(moves) / (2 * split * split)
        unit = max(max(abs(px - x), abs(py - y)) for px, py in raw)
        return Solved([x, y, angle], np.array([1.0, 1.0, float(turning * unit)]), unit, True)
