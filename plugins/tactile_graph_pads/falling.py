"""Whether readings fall under pressure rather than rise, and what elements read at rest then."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
MAD_TO_SIGMA = 1.4826
"""Of a normal distribution: standard deviation over median absolute deviation."""
PLAIN = 8.0
"""Noises beyond which a reading lies plainly off what its element reads at rest."""
CLOSE = 5.0
"""Noises around the level at which most of the pad rests, within which an element rests, too."""
AT_REST = 0.1
"""Share of the frames in which it must do so."""
MOSTLY = 10.0
"""Times as far, over all frames, as readings rise they must fall for pressure to be why."""
FEW = 16
"""Elements below which one that falls tells; of more, the second does: single ones come loose."""
MOST_AT_ONCE = 0.5
"""Share of the elements up to which they are pressed together; of more, the whole pad drifts."""
MOST_LOOKED_AT = 200_000
TURN_ROUND = "--with invert_from=… (what the pad reads at rest, or full scale) turns them round"


class Fall(NamedTuple):
    """In how many frames readings fall plainly, and by how much at most, in their unit."""

    frames: int
    most: float


def fall_of(values: Array, rest: Array | float, noise: float, read: Flags) -> Fall | None:
    """Return how readings fall under pressure; None where they rise, or do neither.

    Parameters
    ----------
    values : ndarray, shape (frames, rows, columns)
    rest : ndarray, shape (rows, columns), or float
        What elements read with nothing on them.
    noise : float
        Standard deviation of a reading of one of them.
    read : ndarray of bool, shape (rows, columns)
        The elements that count.

    Notes
    -----
    In a frame, whichever goes farther tells: beside a touch on a pad whose readings rise they may
    fall by less, even in more places. Frames in which most elements fall at once tell nothing.
    """
    plain = PLAIN * noise
    if not any((off < -plain).any() for off in _off(values, rest, read)):
        return None
    n = int(np.count_nonzero(read))
    last = 1 if n < FEW else 2
    fallen, fall, rise, most = 0, 0.0, 0.0, 0.0
    for off in _off(values, rest, read):
        if np.count_nonzero(off < -plain) > MOST_AT_ONCE * n:
            continue
        parted = np.partition(np.nan_to_num(off), (last - 1, n - last))
        below, above = -float(parted[last - 1]), float(parted[n - last])
        if below > max(above, plain):
            fallen, fall, most = fallen + 1, fall + below, max(most, -float(parted[:last].min()))
        elif above > plain:
            rise += above
    return Fall(fallen, most) if fall > MOSTLY * rise else None


def _off(values: Array, rest: Array | float, read: Flags) -> Iterator[Array]:
    """Yield by how much each frame's readings lie above rest, shape (elements,)."""
    every = bool(read.all())
    for frame in values:
        off = frame - rest
        yield off.ravel() if every else off[read]


def level_at_rest(values: Array, noise: float, read: Flags) -> float | None:
    """Return the level close around which most readings of a pad lie; None where there is none.

    Parameters
    ----------
    values, noise, read
        As of `fall_of`.
    """
    stride = max(1, values.size // MOST_LOOKED_AT)
    while math.gcd(stride, read.size) > 1:  # or some cells alone are looked at
        stride += 1
    its = np.arange(0, values.size, stride) % read.size
    some = values.reshape(-1)[::stride][read.reshape(-1)[its]]
    some = np.sort(some[np.isfinite(some)])
    if not some.size:
        return None
    half = (some.size + 1) // 2
    widths = some[half - 1 :] - some[: some.size - half + 1]
    at = int(widths.argmin())
    if widths[at] > 2.0 * CLOSE * noise:
        return None
    return float(some[at + half // 2])


def resting_with_the_pad(values: Array, rest: Array, noise: float, read: Flags) -> Array:
    """Return what elements rest at, put right where they often read what most of the pad does.

    Parameters
    ----------
    values, noise, read
        As of `fall_of`.
    rest : ndarray, shape (rows, columns)
        What each seems to rest at by itself. It is not so where it is pressed, or lies beside what
        is, in most of the frames.
    """
    level = level_at_rest(values, noise, read)
    if level is None:
        return rest
    far = read & (np.abs(rest - level) > PLAIN * noise)
    if not 0 < np.count_nonzero(far) <= MOST_AT_ONCE * np.count_nonzero(read):
        return rest
    its = values[:, far]
    close = np.abs(its - level) <= CLOSE * noise
    often = close.mean(axis=0) >= AT_REST
    found = rest.copy()
    if often.any():
        put = rest[far]
        put[often] = np.nanmedian(np.where(close, its, np.nan)[:, often], axis=0)
        found[far] = put
    return found


class Among(NamedTuple):
    """What elements rest at in a recording with objects, by themselves and with the whole pad.

    The last is the standard deviation of a reading of the median element.
    """

    own: Array
    rest: Array
    noise: float


def rest_among(values: Array, read: Flags, step: float) -> Among:
    """Return what elements read at rest, in a recording no frames of which are known to be empty.

    Parameters
    ----------
    values, read
        As of `fall_of`.
    step : float
        Least difference of two readings; 0 where they are continuous.
    """
    held = np.where(read, values, 0.0)
    own = np.nanmedian(held, axis=0)
    spread = MAD_TO_SIGMA * np.nanmedian(np.abs(held - own), axis=0)
    noise = max(float(np.median(spread[read])), step / np.sqrt(12.0))
    return Among(own, resting_with_the_pad(held, own, noise, read), noise)
