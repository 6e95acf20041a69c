"""``simplify_polygon``: a polygon of few corners from one of many, such as a hull of cells."""

from __future__ import annotations

import math
from typing import Annotated

import numpy as np
from annotated_types import Ge, Gt
from numpy.typing import NDArray

from tactile_graph.errors import Degenerate
from tactile_graph.wires import Polygon

Values = NDArray[np.float64]

PARALLEL = 0.17  # sine of the angle (10 degrees) below which two sides' lines are not crossed


class SimplifyPolygon:
    """Return a polygon of few corners that keeps close to one of many.

    Parameters
    ----------
    corners : int, optional
        How many corners to keep.
    tolerance_cm : float, optional
        Instead: corners go as long as each is no further from the line between its neighbours.
    refine : bool
        Whether each side then becomes the line of least squares through the part of the outline
        it stands for, with corners where neighbouring sides meet; otherwise the corners kept are
        some of those given.

    Raises
    ------
    ValueError
        Unless exactly one of ``corners`` and ``tolerance_cm`` is given.

    Notes
    -----
    The corner whose triangle with its neighbours is smallest goes first (Visvalingam and Whyatt
    1993, 10.1179/000870493786962263), which alone would make a convex polygon smaller; with
    ``refine`` it keeps its size. Sides that come out nearly parallel to their neighbours keep the
    given corner between them.
    """

    stateless = True

    def __init__(
        self,
        *,
        corners: Annotated[int | None, Ge(3)] = None,
        tolerance_cm: Annotated[float | None, Gt(0)] = None,
        refine: bool = True,
    ) -> None:
        if (corners is None) == (tolerance_cm is None):
            got = "neither" if corners is None else "both"
            raise ValueError(f"exactly one of corners and tolerance_cm must be given, got {got}")
        self._corners, self._tolerance, self._refine = corners, tolerance_cm, refine

    def __call__(self, polygon: Polygon) -> Polygon:
        """Return the simplified polygon.

        Raises
        ------
        Degenerate
            If the polygon has fewer corners than asked for (than 3, with ``tolerance_cm``).
        """
        xy = polygon.xy_cm
        least = self._corners or 3
        if len(xy) < least:
            raise Degenerate(
                f"the polygon has {len(xy)} corners, fewer than the {least} it is to keep"
            )
        kept = _kept(xy, least, self._tolerance)
        return Polygon(_refined(xy, kept) if self._refine else xy[kept].copy())


def _kept(xy: Values, least: int, tolerance_cm: float | None) -> list[int]:
    """Return the indices of the corners kept, in order."""
    kept = list(range(len(xy)))
    while len(kept) > least:
        at = xy[kept]
        before, after = np.roll(at, 1, axis=0), np.roll(at, -1, axis=0)
        base = after - before
        twice = np.abs(base[:, 0] * (at - before)[:, 1] - base[:, 1] * (at - before)[:, 0])
        if tolerance_cm is not None:
            size = np.hypot(base[:, 0], base[:, 1])
            height = np.divide(twice, size, out=np.zeros_like(twice), where=size > 0.0)
            twice = np.where(height <= tolerance_cm, twice, np.inf)
        worst = int(twice.argmin())
        if math.isinf(twice[worst]):
            break
        del kept[worst]
    return kept


def _refined(xy: Values, kept: list[int]) -> Values:
    """Return where the lines through the outline's parts between kept corners meet."""
    n = len(kept)
    lines = [_line(xy, kept[k], kept[(k + 1) % n]) for k in range(n)]
    out = xy[kept].copy()
    reach = 0.25 * float(np.ptp(xy, axis=0).max())
    for k in range(n):
        (px, py, dx, dy), (qx, qy, ex, ey) = lines[k - 1], lines[k]
        cross = dx * ey - dy * ex
        if abs(cross) < PARALLEL:
            continue
        along = ((qx - px) * ey - (qy - py) * ex) / cross
        meet = np.array([px + along * dx, py + along * dy])
        if math.hypot(*(meet - out[k])) <= reach:
            out[k] = meet
    return out


def _line(xy: Values, start: int, end: int) -> tuple[float, float, float, float]:
    """Return a point of, and the direction of, the line nearest to the outline from start to end.

    Every point of the outline counts, not its corners: a side is its middle and, along itself, a
    twelfth of its square.
    """
    n = len(xy)
    part = xy[[(start + k) % n for k in range((end - start) % n + 1)]]
    sides = np.diff(part, axis=0)
    sizes = np.hypot(sides[:, 0], sides[:, 1])
    middles = 0.5 * (part[1:] + part[:-1])
    centre = sizes @ middles / sizes.sum()
    off = middles - centre
    scatter = (off * sizes[:, None]).T @ off + (sides * sizes[:, None]).T @ sides / 12.0
    angle = 0.5 * math.atan2(2.0 * scatter[0, 1], scatter[0, 0] - scatter[1, 1])
    return float(centre[0]), float(centre[1]), math.cos(angle), math.sin(angle)
