"""What each element reads when nothing lies on it: offset, noise, drift, and what is odd."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError
from tactile_graph_pads.falling import MAD_TO_SIGMA
from tactile_graph_pads.learning.pressed import often_pressed

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
LEAST_FRAMES = 5
LEAST_FRAMES_WITH_OBJECTS = 10
STANDS_OUT = 8.0
"""Spreads of the others by which an element's offset is unlike theirs."""
LEAST_OBJECT = 4
"""Neighbouring elements that stand out together: then something lies on them."""
MANY = 0.2
"""Share of elements above the others from which on that may be how offsets scatter."""
BY_CHANCE = 2.5
"""Standard deviations by which more neighbours than by chance are alike: then by an object."""
MOST_TOUCHED = 0.1
"""Share of an empty recording's frames that may be left out as touched."""


class Resting(NamedTuple):
    """The empty pad; arrays have the shape (rows, columns) and the unit of the readings.

    ``stuck``, ``still``, ``noisy`` and ``missing`` say which elements are no good (still ones never
    change while the others do); ``drift`` is how far the
    median element moved from first to last frame; ``step`` is the smallest difference of readings
    (0 where they are continuous); ``left_out`` counts touched frames.
    """

    offset: Array
    noise: Array
    stuck: Flags
    still: Flags
    noisy: Flags
    missing: Flags
    drift: float
    step: float
    frames: int
    left_out: int
    from_empty: bool

    @property
    def good(self) -> Flags:
        """Which elements read as they should."""
        return ~(self.stuck | self.still | self.noisy | self.missing)

    @property
    def usual_noise(self) -> float:
        """Noise of the median good element."""
        return float(np.median(self.noise[self.good])) if self.good.any() else 0.0

    def stepped(self, step: float) -> Resting:
        """Return the same for readings in steps: no noise is less than their rounding.

        A converter coarser than the noise shows no step while the pad is empty.
        """
        step = max(step, self.step)
        return self._replace(step=step, noise=np.maximum(self.noise, step / np.sqrt(12.0)))


def resting(values: Array, where: str) -> Resting:
    """Return what a recording of the empty pad says.

    Parameters
    ----------
    values : ndarray, shape (frames, rows, columns)
        NaN where an element was not read.
    where : str
        The recording, for errors.

    Raises
    ------
    DataError
        If there are too few frames, or something lies on the pad, or comes and goes.

    Notes
    -----
    Noise is the standard deviation around each element's own straight line over time, so that a
    slow drift does not pass for noise.
    """
    if len(values) < LEAST_FRAMES:
        raise DataError(
            where,
            f"too few frames of the empty pad: got {len(values)}, at least {LEAST_FRAMES} are "
            "needed for its noise, and 100 tell it within 7 %",
        )
    missing = np.isnan(values).mean(axis=0) > 0.5
    if missing.all():
        raise DataError(where, "no element was ever read")
    held = np.where(np.isnan(values), np.nanmedian(np.where(missing, 0.0, values), axis=0), values)
    touched = _touched_frames(held)
    _refuse_touched(touched, where)
    kept = held[~touched]
    offset, noise, drift = _line(kept)
    step = step_of(kept)
    stuck, still, noisy = _odd(offset, noise, missing, step)
    _refuse_object(offset, stuck, missing, where, "all the time; take off what lies there, or "
                   "give this recording as one of objects")  # fmt: skip
    return Resting(
        offset,
        noise,
        stuck,
        still,
        noisy,
        missing,
        drift,
        step,
        len(kept),
        int(touched.sum()),
        True,
    )


def resting_among_objects(values: Array, where: str) -> Resting:
    """Return the same from recordings with objects, each element taken where it is untouched.

    Parameters
    ----------
    values : ndarray, shape (frames, rows, columns)
    where : str

    Raises
    ------
    DataError
        If there are too few frames, or something lies in one place in more than half of them.

    Notes
    -----
    Offset is the median over frames, and noise the root mean square of what lies below it: both
    hold as long as an element is touched in less than half of the frames. Where the device cuts
    readings off at rest, it may be touched oftener: `often_pressed`.
    """
    if len(values) < LEAST_FRAMES_WITH_OBJECTS:
        raise DataError(
            where,
            f"too few frames to tell the empty pad without a recording of it: got {len(values)}, "
            f"at least {LEAST_FRAMES_WITH_OBJECTS} are needed; record the pad with nothing on it "
            "and give it by --empty",
        )
    missing = np.isnan(values).mean(axis=0) > 0.5
    if missing.all():
        raise DataError(where, "no element was ever read")
    held = np.where(missing, 0.0, values)
    offset, step = np.nanmedian(held, axis=0), step_of(held)
    pressed, rest = often_pressed(held, offset, missing, step)
    offset[pressed] = rest
    below = held - offset
    np.fmin(below, 0.0, out=below)  # 0, too, where an element was not read
    squares = np.square(below, out=below).sum(axis=0)
    noise = np.sqrt(squares / np.maximum((held < offset).sum(axis=0), 1))
    stuck, still, _ = _odd(offset, noise, missing, step)
    _refuse_object(offset, stuck, missing, where, "in more than half of the frames, so that the "
                   "empty pad cannot be told; record it and give it by --empty")  # fmt: skip
    noisy = np.zeros_like(stuck)  # what lies below the median is not all noise
    return Resting(offset, noise, stuck, still, noisy, missing, 0.0, step, len(held), 0, False)


def step_of(values: Array) -> float:
    """Return the smallest difference of readings; 0 where they are continuous."""
    some = values[np.isfinite(values)][:200_000]
    levels = np.unique(some)
    if len(levels) < 2 or len(levels) > 0.2 * len(some):
        return 0.0
    return float(np.diff(levels).min())


def _line(values: Array) -> tuple[Array, Array, float]:
    """Return each element's median, its scatter around its line, and the median element's way."""
    n = len(values)
    at = np.linspace(-0.5, 0.5, n)[:, None, None]
    slope = (at * values).sum(axis=0) / (at**2).sum()
    left = values - values.mean(axis=0) - slope * at
    noise = np.sqrt((left**2).sum(axis=0) / max(n - 2, 1))
    return np.median(values, axis=0), noise, float(np.median(slope))


def _touched_frames(values: Array) -> Flags:
    """Return in which frames neighbours read far above their own median together."""
    from scipy import ndimage

    middle = np.median(values, axis=0)
    above = values - middle
    noise = MAD_TO_SIGMA * np.median(np.abs(above), axis=0)
    # Noise that a device cuts off at 0 is not in the median deviation, but in what rises, in the
    # lower half of the frames, too: in others much of the pad may be touched.
    lower = np.argsort(above.sum(axis=(1, 2)), kind="stable")[: (len(above) + 1) // 2]
    rise = float(np.median(np.quantile(above[lower], 0.84, axis=0)))
    usual = max(float(np.median(noise)), rise, step_of(values) / np.sqrt(12.0))
    if usual == 0.0:
        usual = 1e-6 * max(float(np.abs(middle).max()), 1e-300)
    high = above > STANDS_OUT * np.maximum(noise, usual)
    touched = np.zeros(len(values), np.bool_)
    for n in np.flatnonzero(high.sum(axis=(1, 2)) >= LEAST_OBJECT):
        touched[n] = any(_is_object(part) for part in _parts(high[n], ndimage))
    return touched


def _parts(on: Flags, ndimage: object) -> list[Flags]:
    labels, count = ndimage.label(on)  # type: ignore[attr-defined]
    return [labels == k for k in range(1, count + 1)]


def _is_object(part: Flags) -> bool:
    """Return whether elements lie together as under an object, not along one line."""
    row, column = np.nonzero(part)
    both_ways = len(np.unique(row)) > 1 and len(np.unique(column)) > 1
    return len(row) >= LEAST_OBJECT and both_ways


def _odd(offset: Array, noise: Array, missing: Flags, step: float) -> tuple[Flags, Flags, Flags]:
    """Return which elements read far from the others, never change, and scatter far more."""
    read = ~missing
    middle = float(np.median(offset[read]))
    usual = float(np.median(noise[read]))
    least = max(2.0 * usual, step, 1e-9 * abs(middle))
    far = STANDS_OUT * max(_spread(offset - middle, read, least), least)
    stuck = read & (np.abs(offset - middle) > far)
    floor = max(usual, step / np.sqrt(12.0))
    noisy = read & ~stuck & (noise > 4.0 * floor) if floor > 0.0 else np.zeros_like(read)
    still = read & ~stuck & (noise <= 1e-9 * usual) & (usual > step)
    return stuck, still, noisy


def _spread(apart: Array, read: Flags, least: float) -> float:
    """Return how far offsets scatter around their middle, also where a device cuts them off at it.

    Parameters
    ----------
    apart : ndarray, shape (rows, columns)
        Offsets less their middle.
    read : ndarray of bool, shape (rows, columns)
    least : float
        What is more is above the middle.

    Notes
    -----
    Half of the offsets read 0 then, and their median deviation is none. Those above tell the
    spread, where they are many and lie anywhere: under an object they lie side by side.
    """
    spread = MAD_TO_SIGMA * float(np.median(np.abs(apart[read])))
    above = read & (apart > least)
    if above.sum() < MANY * read.sum() or _side_by_side(above, read):
        return spread
    return max(spread, MAD_TO_SIGMA * float(np.median(apart[above])))


def _side_by_side(on: Flags, read: Flags) -> bool:
    """Return whether elements are neighbours oftener than by chance."""
    pairs = both = 0
    for one, other in ((np.s_[:, 1:], np.s_[:, :-1]), (np.s_[1:], np.s_[:-1])):
        pairs += int(np.count_nonzero(read[one] & read[other]))
        both += int(np.count_nonzero(on[one] & on[other]))
    expected = pairs * (on.sum() / read.sum()) ** 2
    return bool(both > expected + BY_CHANCE * np.sqrt(expected))


def _refuse_touched(touched: Flags, where: str) -> None:
    if touched.mean() <= MOST_TOUCHED:
        return
    first = int(np.flatnonzero(touched)[0])
    raise DataError(
        where,
        f"not empty: in {touched.sum()} of {len(touched)} frames, first in frame {first}, "
        "neighbouring elements read far more than in the others; record the pad with nothing on "
        "it, or give this recording as one of objects",
    )


def _refuse_object(offset: Array, stuck: Flags, missing: Flags, where: str, rest: str) -> None:
    """Raise where neighbouring elements stand out together; ``rest`` ends the message."""
    from scipy import ndimage

    middle = float(np.median(offset[~missing]))
    for part in _parts(stuck & (offset > middle), ndimage):
        if _is_object(part):
            row, column = (int(np.median(v)) for v in np.nonzero(part))
            raise DataError(
                where,
                f"not empty: {int(part.sum())} neighbouring elements around row {row}, column "
                f"{column} read {float(np.median(offset[part]) - middle):.4g} above the others "
                f"{rest}",
            )
