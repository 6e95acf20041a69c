"""Known loads and what they read as, with error bars: what a calibration is fitted to."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError
from tactile_graph_pads.calibration.calibration import Point

Array = NDArray[np.float64]
LEAST_RISE = 0.02
"""A reading that grows with a smaller power of the load than this no longer tells loads apart."""
REPEATS_WITHIN = 0.15
"""What the maker states as the worst repeatability: scatter assumed of a single placement."""


class Observation(NamedTuple):
    """One placement of a known load on a group of neighbouring elements.

    Parameters
    ----------
    load_g : float
        On each element of the group.
    readings : ndarray, shape (k,)
        The group's elements.
    source : str
        File and frame, for errors.
    """

    load_g: float
    readings: Array
    source: str = ""


def points_of(observations: Sequence[Observation], where: str = "calibration") -> list[Point]:
    """Return one point for each load, by rising load.

    Parameters
    ----------
    observations : sequence of Observation
    where : str
        What errors name.

    Raises
    ------
    DataError
        If a load is not above 0, or a load reads nothing, or the readings contradict the order
        of the loads, or they no longer rise at the heavy end.

    Notes
    -----
    Each placement is averaged over its group first (four neighbours in thesis section 2.4.2),
    then over placements; ``sd`` is the scatter of the former, ``sd_single`` that of elements.
    """
    by_load: dict[float, list[Observation]] = {}
    for seen in observations:
        if not (math.isfinite(seen.load_g) and seen.load_g > 0.0):
            raise DataError(seen.source or where, f"a load must be above 0 g, got {seen.load_g:g}")
        by_load.setdefault(float(seen.load_g), []).append(seen)
    points = [_point(load, by_load[load], where) for load in sorted(by_load)]
    _check_order(points, by_load, where)
    _check_rise(points, where)
    return points


def _point(load_g: float, seen: list[Observation], where: str) -> Point:
    means = np.array([o.readings.mean() for o in seen])
    single = np.concatenate([o.readings for o in seen])
    if means.mean() <= 0.0:
        raise DataError(
            seen[0].source or where,
            f"a load of {load_g:g} g an element reads {means.mean():.4g}, which is nothing: "
            "is it on the pad, and was the empty pad taken off?",
        )
    return Point(
        load_g=load_g,
        reading=float(means.mean()),
        sd=float(means.std(ddof=1)) if len(means) > 1 else 0.0,
        sd_single=float(single.std(ddof=1)) if len(single) > 1 else 0.0,
        placements=len(means),
        elements=len(single),
    )


def _check_order(points: list[Point], by_load: dict[float, list[Observation]], where: str) -> None:
    """Refuse loads whose readings fall by more than chance lets them."""
    for i, light in enumerate(points):
        for heavy in points[i + 1 :]:
            drop = light.reading - heavy.reading
            if drop > math.hypot(_tolerance(light), _tolerance(heavy)):
                files = " and ".join(
                    dict.fromkeys(o.source for p in (light, heavy) for o in by_load[p.load_g])
                )
                raise DataError(
                    where,
                    f"loads in disorder: {heavy.load_g:g} g reads {heavy.reading:.4g}, less than "
                    f"the {light.reading:.4g} of {light.load_g:g} g; were loads mixed up"
                    + (f" ({files[:200]})?" if files else "?"),
                )


def _tolerance(point: Point) -> float:
    share = max(REPEATS_WITHIN * point.reading, 3.0 * point.sd)
    return share / math.sqrt(point.placements)


def _check_rise(points: list[Point], where: str) -> None:
    """Refuse a heavy end at which the reading stands still while the load doubles."""
    if len(points) < 2:
        return
    top = points[-1]
    below = next((p for p in reversed(points[:-1]) if 2.0 * p.load_g <= top.load_g), points[-2])
    rise = math.log(top.reading / below.reading) / math.log(top.load_g / below.load_g)
    if rise < LEAST_RISE:
        raise DataError(
            where,
            f"saturated: from {below.load_g:g} to {top.load_g:g} g an element the reading goes "
            f"from {below.reading:.4g} to {top.reading:.4g} and no longer tells loads apart; "
            "leave out the heaviest loads",
        )
