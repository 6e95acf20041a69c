"""What a device cut off below zero of the noise of untouched cells, told by what it left above."""

from __future__ import annotations

import math
from statistics import NormalDist
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph_filters.readings.clipped_noise import FEWEST_AT_REST, is_anywhere

Cells = NDArray[np.bool_]
Values = NDArray[np.float64]
NORMAL = NormalDist()

LEAST, MOST = 0.25, 0.9
"""Of the cells that may be at rest, the share that reads more than zero: half of them in noise
around zero, fewer among dead cells or where readings are rounded, more above an offset."""

LIVE, MOSTLY = 0.25, 0.5
"""Of the cells beside a footprint, the share with readings above zero on or next to them, and of
those, the share away from loads: noise is anywhere, and what is around a load is of it. And the
share where only cells next to loads are left out, and not those next to these."""

REACH, LARGE = 4.0, 6.0
"""Standard deviations up to which a reading is of the noise; times the median of those above zero,
from which on it surely is a load."""

OFF, ROUGH = 2.0, 0.03
"""How far the variance of what is above zero, over its squared mean, may be off that of normal
noise: so much over the root of their number, as hardly one frame of 100 is, and what gains make of
it. Readings any of which is as likely up to a largest are farther off."""


class _Noise(NamedTuple):
    """Normal noise, of which what lies more than half a step above zero is read.

    ``z`` is how far its middle lies above that, in standard deviations.
    """

    z: float
    sigma: float
    step: float

    @property
    def kept(self) -> float:
        """Share that is read."""
        return NORMAL.cdf(self.z)

    @property
    def hazard(self) -> float:
        return _density(self.z) / self.kept

    @property
    def reach(self) -> float:
        return (self.z + REACH) * self.sigma + 0.5 * self.step

    @property
    def cut(self) -> float:
        """Mean of what is below zero, over all of the noise."""
        middle = self.z + 0.5 * self.step / self.sigma
        return self.sigma * (middle * NORMAL.cdf(-middle) - _density(middle))


def cut_off_below(values: Values, usable: Cells, on: Cells) -> float:
    """Return the sum, less than zero, of what a device that knows no less than zero cut off.

    Parameters
    ----------
    values : ndarray, shape (rows, columns)
        None of the usable ones less than zero.
    usable, on : ndarray of bool, the same shape
        Valid cells, and those of a footprint.

    Returns
    -------
    float
        0.0 where what reads more than zero beside the footprint is no noise: where it is not as
        normal noise is, or lies side by side as loads do.

    Notes
    -----
    Cells that read zero as all around them do are masked or dead, and tell nothing; so do cells
    next to loads. Of the others, where more read something than noise around zero leaves, an offset
    lifts them, which that share tells; where fewer do, some are dead, too, and as much was cut off
    as was left.
    """
    beside = usable & ~on
    above = beside & (values > 0.0)
    live = beside & _beside(above)
    n_above, n_live = (int(np.count_nonzero(cells)) for cells in (above, live))
    share = n_live / max(int(np.count_nonzero(beside)), 1)
    if share < LIVE or not _is_share(n_above, n_live):
        return 0.0
    seen = values.ravel().compress(above.ravel())
    loads = on | (values > LARGE * float(np.partition(seen, n_above // 2)[n_above // 2]))
    next_to = _beside(loads & usable)
    for near in (_beside(next_to), next_to):
        far = live & ~near
        read = values.ravel().compress((far & above).ravel())
        n_far = int(np.count_nonzero(far))
        if is_enough := n_far >= LIVE * n_live and _is_share(read.size, n_far):
            break
        if share < MOSTLY:
            return 0.0
    noise = _noise_of(read, n_far) if is_enough else None
    if noise is None or not is_anywhere.call(values, far, 0.0, noise.reach, 0.0):
        return 0.0
    its = int(np.count_nonzero(seen <= noise.reach))
    return min(its / noise.kept, (n_live - n_above) / (1.0 - noise.kept)) * noise.cut


def may_be_cut_off(n_above: float, n: float, total: float) -> bool:
    """Return whether so many of ``n`` cells beside a footprint read more than zero as noise may."""
    may_be = n - n_above >= FEWEST_AT_REST and LEAST * LIVE * n <= n_above <= MOST * n
    return may_be and math.isfinite(total)


def _is_share(n_above: int, n: int) -> bool:
    """Return whether so many cells may be what noise leaves above zero."""
    return n - n_above >= FEWEST_AT_REST // 2 and LEAST <= n_above / n <= MOST


def _noise_of(read: Values, n: int) -> _Noise | None:
    """Return the noise that readings above zero of ``n`` cells are of; None if they are of none.

    Notes
    -----
    Their median tells its size, and then the mean of those within its reach. Its middle is not
    below zero: what seems so are dead cells.
    """
    read.sort()
    steps = np.diff(read, prepend=0.0)
    step = float(steps[steps > 0.0].min())
    middle = float(read[len(read) // 2])
    lower, upper = (int(read.searchsorted(middle, side)) for side in ("left", "right"))
    half = middle + step * ((0.5 * len(read) - lower) / (upper - lower) - 1.0)
    seems = NORMAL.inv_cdf(len(read) / n)
    z = max(seems, 0.0)
    for _ in range(4):
        sigma = half / (z + NORMAL.inv_cdf(1.0 - 0.5 * NORMAL.cdf(z)))
        z = max(seems, -0.5 * step / sigma)
    noise = _Noise(z, sigma, step)
    return _as_normal(read[: int(read.searchsorted(noise.reach, "right"))], noise)


def _as_normal(its: Values, noise: _Noise) -> _Noise | None:
    """Return the noise by the mean of its readings; None if their variance is not that of noise.

    Readings that are rounded seem larger and spread farther than they are.
    """
    hazard, n = noise.hazard, its.size
    rounded = noise.step / 12.0
    above = its - 0.5 * noise.step
    mean = float(above.sum()) / n - rounded * hazard * (noise.step / noise.sigma)
    above /= mean
    spread = float(above @ above) / n - (rounded / mean) * (noise.step / mean) - 1.0
    expected = (1.0 - hazard * (hazard + noise.z)) / (hazard + noise.z) ** 2
    if not abs(spread - expected) <= ROUGH + OFF / math.sqrt(n):
        return None
    return noise._replace(sigma=mean / (hazard + noise.z))


def _density(z: float) -> float:
    return math.exp(-0.5 * z * z) / math.sqrt(2.0 * math.pi)


def _beside(on: Cells) -> Cells:
    """Return which cells are on, or beside one that is, also across corners."""
    wide = on.copy()
    wide[1:] |= on[:-1]
    wide[:-1] |= on[1:]
    far = wide.copy()
    far[:, 1:] |= wide[:, :-1]
    far[:, :-1] |= wide[:, 1:]
    return far
