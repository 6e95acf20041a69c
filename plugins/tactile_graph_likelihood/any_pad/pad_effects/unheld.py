"""Readings that are alike at the top: held there by a limit of the pad, or an even pad's face."""

from __future__ import annotations

import math

import numpy as np

from tactile_graph_likelihood.any_pad.pad_effects.from_frame import NORMAL
from tactile_graph_likelihood.any_pad.pad_effects.gap import sized
from tactile_graph_likelihood.geometry.covered import covered
from tactile_graph_likelihood.geometry.outlines import DISC, unknowns
from tactile_graph_likelihood.single.density.element_terms import HIGH, ON, OVER, SPAN, UNKNOWN
from tactile_graph_likelihood.single.model import Likeliest, Model
from tactile_graph_likelihood.single.noise import LEAST_SIGMA
from tactile_graph_likelihood.single.readings import Readings

RIM = 0.4
"""Share of the elements under an outline's rim that must read less than the most: where a limit
holds much of a face, few of them do."""

WHOLE, LITTLE = 0.97, 0.1
"""Covered share from which on an element is of the face, and from which on it is under the rim."""

MOST_VOIDS = 0.05
"""Share of the elements of an even pad's face that read nothing."""

FEWEST = 4
"""Elements of the face, and under the rim, that tell how they scatter."""

COARSE = 0.03
"""Of ln load: no coverage is known better."""

STRANGE = 2.0
"""Deviations by which readings under the rim are off that no even face explains."""

FAR = 2.0
"""Nats for each of the alike readings by which an even face that is worth a second look may
explain readings worse at first, while the gap is as told."""


def unheld(model: Model, readings: Readings, even: Likeliest) -> tuple[Readings, Likeliest]:
    """Return readings that no limit holds, and the outline by them, where they are rather that.

    Otherwise the same.

    Parameters
    ----------
    model : Model
        Of an even face.
    readings : Readings
    even : Likeliest
        The outline by readings of which some are `OVER`.

    Returns
    -------
    (Readings, Likeliest)

    Notes
    -----
    Where a limit holds readings, those that it holds are alike and others scatter with the gains;
    where elements are even, all are explained by one small scatter, at the rim, too. Held readings
    are normal around the limit, with their own deviation, if they are as dense as the others. Under
    the rim an even pad's readings scatter as those of its face do, and by the noise.
    """
    over = readings.states == OVER
    if not over.any():  # a limit may hold other contacts alone
        readings = readings._replace(unheld=None)
    if readings.unheld is None or even.mode.height == -math.inf:
        return readings, even
    logs, n = readings.unheld[over], int(np.count_nonzero(over))
    free = readings._replace(
        logs=readings.unheld, states=np.where(over, np.uint8(ON), readings.states), unheld=None
    )
    spread = max(float(logs.std()), LEAST_SIGMA)
    held = even.mode.height + n * math.log(
        SPAN * HIGH / (spread * math.sqrt(2.0 * math.pi * math.e))
    )
    its = model.likeliest_near(free, model.point_of(even))
    if its.mode.height < held - FAR * n or readings.touched - n < RIM * _on_rim(model, free, its):
        return readings, even
    free, its = sized(model, free, its)
    if its.mode.height <= held or _strangeness(model, free, its, readings.noise) > STRANGE:
        return readings, even
    return free, its


def _on_rim(model: Model, readings: Readings, its: Likeliest) -> float:
    """Return on about how many elements an outline's rim lies."""
    pitch, side = readings.grid[2:4].tolist()
    a, b = (its.mode.p[2:4] if model.kind != DISC else its.mode.p[[2, 2]]).tolist()
    return float(4.0 * (a + b) * side / (pitch * pitch))


def _strangeness(model: Model, readings: Readings, its: Likeliest, noise: float) -> float:
    """Return how much more readings under the rim scatter than those of the face and noise do.

    Infinite where the face has voids, which no even pad has.
    """
    p, shape = model.point_of(its), readings.states.shape
    share = covered.call(model.kind, model.corners, p, readings.grid, (0, 0, *shape))
    shows, known = readings.states == ON, readings.states != UNKNOWN
    face, rim = shows & (share >= WHOLE), shows & (share > LITTLE) & (share < WHOLE)
    voids = np.count_nonzero(known & ~shows & (share >= WHOLE))
    if voids > max(MOST_VOIDS * np.count_nonzero(known & (share >= WHOLE)), 1.0):
        return math.inf
    if np.count_nonzero(face) < FEWEST or np.count_nonzero(rim) < FEWEST:
        return math.inf
    logs, load = readings.logs, float(p[unknowns.call(model.kind, model.corners)])
    std = np.hypot(max(float(logs[face].std()), COARSE), noise / np.exp(logs[rim]))
    off = (logs[rim] - load - np.log(share[rim])) / std
    return NORMAL * float(np.median(np.abs(off)))
