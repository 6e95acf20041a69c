"""What the frames of one sensor are like: range, noise, offset, broken cells, contacts."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.wires import Frame
from tactile_graph_pads.circuits.ghosts import ghosts_in
from tactile_graph_pads.falling import Fall, fall_of, resting_with_the_pad
from tactile_graph_sources.inspection.sign import sign_is_lost
from tactile_graph_sources.readers.sequence.leaps import is_leap

Stack = NDArray[np.float64]
MAD_TO_SD = 1.4826
IDLE_QUANTILE = 0.1
QUIET = 0.25
FEWEST_CHANGES = 0.25
FEWEST_FRAMES = 5
"""Frames from which on a cell that never changes says something."""
TOUCHED = 0.2
"""Share of the peak above the offset that a cell's neighbours must have seen to call it dead."""
IN_BURSTS = 0.2
"""Share of frames at the very time of the one before, from which on times tell no single step."""
OUT_OF_ORDER = 3.0
"""Usual steps by which frames may come out of order, on one clock."""
STUCK, MOST_STUCK, FEWEST_TO_STICK = 0.05, 0.2, 30
"""Share of the peak above the offset at which a cell that never changes is stuck; the most of all
such cells that can be; and the frames it takes."""
FAR_BELOW = 10.0
"""Spreads of how cells rest, by which one that never changes lies below them to be dead."""
NOISY = 5.0
ABOVE_NOISE = 5.0
SHARE_OF_PEAK = 0.05
SMALLEST_CONTACT = 2
LASTING = 0.25
"""Share of the highest reading that a patch must reach at rest to be an object that stays there:
what pads read by themselves differs less from cell to cell."""
FULL_SCALES = (255, 511, 1023, 2047, 4095, 8191, 16383, 32767, 65535)
TOGETHER = 1_000_000
"""Readings that are copied at once."""
Cells = tuple[tuple[int, int], ...]


@dataclass(frozen=True)
class Measured:
    """What one sensor's frames are like; levels in the recording's own unit.

    Parameters
    ----------
    n_frames : int
    shape : (int, int)
        Rows and columns.
    rate_hz, jitter : float, optional
        Frames a second, and the spread of the steps over their median, None where frames come in
        bursts; both None without times.
    n_leaps : int
        Times that go back, or leap by many usual steps.
    duration_s : float, optional
    lowest, highest : float
        Of all valid cells.
    step : float, optional
        The smallest difference of two readings, where all are whole multiples of it.
    full_scale : int, optional
        Where readings are whole and reach the end of a converter's range.
    sign_lost : bool
        Whether they look like signed numbers of 16 bits that were written without their sign.
    noise : float, optional
        Standard deviation of a cell at rest from frame to frame, that of the quieter quarter of
        the cells: the others may be pressed all the time. None with fewer than five frames.
    offset, offset_spread : float
        Level of a cell at rest (its lowest tenth, or near what most cells read in most frames,
        where it often is), the median of the cells and the distance of
        the tenth from the ninetieth percentile.
    dead, stuck, noisy, missing : tuple of (int, int)
        Row and column, from 0, of cells that never change while those around them are pressed, or
        far below how these rest, of those that rest far above the others, that are several times
        as noisy, that hold no value.
    n_contacts : tuple of int
        Patches of two cells or more above ``contact_level``, for each frame.
    contact_level : float
        Above the offset, or below it where readings fall: five times the noise, or a twentieth of
        the farthest reading.
    n_lasting : int
        Those that are there in every frame, as what lies on the pad from first to last.
    n_ghosts, n_telling : int
        Frames that look as on a matrix without isolation, and those that could tell.
    n_gaps, n_truths : int
        Frames that follow a gap, and that carry truth.
    falls : Fall, optional
        How readings fall under pressure, where they do instead of rising.
    fullest : int
        Which frame has the most beyond its noise.
    """

    n_frames: int
    shape: tuple[int, int]
    rate_hz: float | None
    jitter: float | None
    n_leaps: int
    duration_s: float | None
    lowest: float
    highest: float
    step: float | None
    full_scale: int | None
    sign_lost: bool
    noise: float | None
    offset: float
    offset_spread: float
    dead: Cells
    stuck: Cells
    noisy: Cells
    missing: Cells
    n_contacts: tuple[int, ...]
    contact_level: float
    n_lasting: int
    n_ghosts: int
    n_telling: int
    n_gaps: int
    n_truths: int
    falls: Fall | None
    fullest: int


def stack_of_frames(frames: Sequence[Frame]) -> Stack:
    """Return values of frames of one shape, (frames, rows, columns); NaN where a cell has none."""
    stack = np.empty((len(frames), *frames[0].image.shape))
    for values, frame in zip(stack, frames, strict=True):
        values[...] = frame.image.filled(np.nan)
    return stack


def measure(frames: Sequence[Frame]) -> Measured:
    """Return what frames of one sensor and one shape are like.

    Notes
    -----
    Noise is taken from the median of each cell's differences from frame to frame, so that the
    minority of frames in which it is being pressed or let go do not count. Where three in four
    readings repeat it comes out as 0, which says only that it is far below one step.
    """
    stack = stack_of_frames(frames)
    with np.errstate(over="ignore", invalid="ignore"):
        finite = np.isfinite(stack)
        known, whole = np.asarray(finite.any(axis=0)), bool(finite.all())
        values = stack.ravel() if whole else stack[finite]
        step = _step(values)
        lowest, highest = _ends(values)
        sign_lost = sign_is_lost(values, step, highest)
        del values
        filled = stack
        if not whole:
            np.copyto(filled, np.nan_to_num(_median(stack)), where=~finite)
        idle = _idle(filled, known)
        silent = _silent(filled, idle, known, step or 0.0)
        alive = known & ~silent
        sigma = _noise(filled, step or 0.0)
        noise = (
            None if sigma is None or not alive.any() else float(np.quantile(sigma[alive], QUIET))
        )
        if noise is not None:
            idle = resting_with_the_pad(filled, idle, noise, alive)
        offset = float(np.median(idle[alive])) if alive.any() else 0.0
        falls = fall_of(filled, idle, _at_least(noise, step), alive) if noise is not None else None
        peak = highest - offset if falls is None else falls.most
        level = max(ABOVE_NOISE * (noise or 0.0), SHARE_OF_PEAK * peak)
        dead, stuck = _still(filled, idle, alive, _Levels(offset, highest, noise or 0.0))
        dead |= silent
        pace = _pace(frames)
        spread = np.quantile(idle[alive], [0.1, 0.9]) if alive.any() else np.zeros(2)
        lasting, n_lasting = _lasting(
            np.where(stuck, offset, idle) - offset, level, highest - offset
        )
        at_rest, way = np.where(lasting, offset, idle), 1.0 if falls is None else -1.0
        seen = [_seen(way * (f - at_rest), level, ABOVE_NOISE * (noise or 0.0)) for f in filled]
        return Measured(
            len(frames),
            (filled.shape[1], filled.shape[2]),
            *pace,
            lowest,
            highest,
            step,
            _full_scale(step, highest),
            sign_lost,
            noise,
            offset,
            float(spread[1] - spread[0]),
            _cells(dead),
            _cells(stuck),
            _cells(_noisy(sigma, noise, alive & ~dead & ~stuck)),
            _cells(~known),
            tuple(its.contacts for its in seen),
            level,
            n_lasting,
            *_ghosts(filled, idle, level, alive & ~stuck),
            sum(f.gap for f in frames),
            sum(f.truth is not None for f in frames),
            falls,
            max(range(len(seen)), key=lambda k: seen[k][1:]),
        )


def _median(stack: Stack) -> Stack:
    """Return each cell's median over time; 0 where it never has a value."""

    def middle(rows: slice) -> Stack:
        part = stack[:, rows]
        found, some = np.zeros(part.shape[1:]), np.isfinite(part).any(axis=0)
        found[some] = np.nanmedian(part[:, some], axis=0)
        return found

    return _by_rows(middle, stack)


def _idle(filled: Stack, known: NDArray[np.bool_]) -> Stack:
    """Return each cell's level at rest; with too few frames the same for all, their median."""
    if len(filled) >= FEWEST_FRAMES:
        return _by_rows(lambda rows: np.quantile(filled[:, rows], IDLE_QUANTILE, axis=0), filled)
    level = float(np.median(filled[:, known])) if known.any() else 0.0
    return np.full(filled.shape[1:], level)


def _noise(filled: Stack, step: float) -> Stack | None:
    """Return each cell's standard deviation at rest; None with too few frames.

    Readings in steps are spread over their step at random, and what that adds is taken off again:
    the median of whole numbers would be one itself. A cell of which three in four readings repeat
    has none that could be measured.
    """
    if len(filled) < FEWEST_FRAMES:
        return None
    shape = (len(filled) - 1, *filled.shape[1:])
    # Nothing is at random where readings are continuous.
    off = np.random.default_rng(0).uniform(-0.5, 0.5, shape) if step else None

    def changes(rows: slice) -> Stack:
        """Return the share of frames in which cells change, and the median of the changes."""
        change = np.diff(filled[:, rows], axis=0)
        often = (change != 0.0).mean(axis=0)
        if off is not None:
            change += step * off[:, rows]
        middle = np.median(np.abs(change, out=change), axis=0, overwrite_input=True)
        return np.stack([often, middle], axis=1)

    often, middle = _by_rows(changes, filled).swapaxes(0, 1)
    trembles = often >= FEWEST_CHANGES
    sigma = MAD_TO_SD * middle / np.sqrt(2.0)
    added = MAD_TO_SD * 0.25 * step / np.sqrt(2.0)
    return np.where(trembles, np.sqrt(np.maximum(sigma**2 - added**2, 0.0)), 0.0)


def _by_rows(found: Callable[[slice], Stack], stack: Stack) -> Stack:
    """Return what is found of each cell over time, a few rows at once: it takes copies of them."""
    n_rows = stack.shape[1]
    at_once = max(1, TOGETHER * n_rows // max(stack.size, 1))
    parts = [slice(first, first + at_once) for first in range(0, n_rows, at_once)]
    return np.concatenate([found(rows) for rows in parts])


def _ends(values: Stack) -> tuple[float, float]:
    return (float(values.min()), float(values.max())) if values.size else (0.0, 0.0)


def _step(values: Stack) -> float | None:
    """Return the step that all readings are whole multiples of, where they have one."""
    if not values.size or max(values.max(), -values.min()) > 1e12:
        return None
    levels = np.unique(values[:: max(1, len(values) // 200_000)])
    if len(levels) < 2:
        return None
    step = float(np.diff(levels).min())
    counts = (levels - levels[0]) / step
    return step if bool((np.abs(counts - np.rint(counts)) < 1e-3).all()) else None


def _full_scale(step: float | None, highest: float) -> int | None:
    whole = step is not None and step % 1 == 0
    return int(highest) if whole and highest in FULL_SCALES else None


class _Levels(NamedTuple):
    """Levels of the whole pad."""

    offset: float
    highest: float
    noise: float


def _still(
    filled: Stack, idle: Stack, known: NDArray[np.bool_], levels: _Levels
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Return which cells are dead and which are stuck: neither ever changes."""
    none, (offset, highest, noise) = np.zeros_like(known), levels
    if len(filled) < FEWEST_FRAMES or highest <= offset:
        return none, none
    still = known & (np.ptp(filled, axis=0) == 0.0)
    if still.all():
        return none, none
    raised = known & (idle - offset > STUCK * (highest - offset))
    long = len(filled) >= FEWEST_TO_STICK
    if noise > 0.0 and long:
        return still & ~raised, still & raised  # where all tremble, such a cell is broken
    # What lies still on a pad without noise keeps its cells as they are: that sticks no cell.
    stuck = still & raised if long and (still & raised).sum() < MOST_STUCK * raised.sum() else none
    reached = filled.max(axis=0) - offset > TOUCHED * (highest - offset)
    pressed = reached & ~still
    sides, live = _beside(pressed), _beside(known & ~still)
    # A neighbour that is dead too says nothing: a whole dead line is found by its two sides.
    between = (sides[0] & sides[1]) | (sides[2] & sides[3])
    around = sides.sum(axis=0) >= 0.75 * live.sum(axis=0)
    return still & ~raised & between & around, stuck


def _silent(filled: Stack, idle: Stack, known: NDArray[np.bool_], step: float) -> NDArray[np.bool_]:
    """Return which cells never change and rest far below those that do, if these are most.

    They tell neither the offset nor the noise of the others.
    """
    still = known & (np.ptp(filled, axis=0) == 0.0)
    moving = known & ~still
    if len(filled) < FEWEST_FRAMES or moving.sum() <= still.sum():
        return np.zeros_like(known)
    rest = float(np.median(idle[moving]))
    spread = max(MAD_TO_SD * float(np.median(np.abs(idle[moving] - rest))), step / np.sqrt(12.0))
    return np.asarray(still & (rest - idle > FAR_BELOW * spread) & (idle < idle[moving].min()))


def _beside(mask: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return the mask's values above, below, left and right of each cell, shape (4, rows, cols)."""
    padded = np.pad(mask, 1)
    return np.stack([padded[:-2, 1:-1], padded[2:, 1:-1], padded[1:-1, :-2], padded[1:-1, 2:]])


def _noisy(sigma: Stack | None, noise: float | None, known: NDArray[np.bool_]) -> NDArray[np.bool_]:
    if sigma is None or not noise:
        return np.zeros_like(known)
    return known & (sigma > NOISY * noise)


def _cells(mask: NDArray[np.bool_]) -> Cells:
    return tuple((int(r), int(c)) for r, c in np.argwhere(mask))


def _lasting(rest: Stack, level: float, highest: float) -> tuple[NDArray[np.bool_], int]:
    """Return the cells of patches that no frame is without, and how many patches.

    Parameters
    ----------
    rest : ndarray, shape (rows, columns)
        What cells read at rest, above the offset.
    level, highest : float
        From which on a cell belongs to a contact; the highest reading. Both above the offset.
    """
    from scipy import ndimage

    labels, n = ndimage.label(rest > level, structure=np.ones((3, 3)))
    numbers = np.arange(1, n + 1)
    sizes = np.bincount(labels.ravel(), minlength=n + 1)[1:]
    peaks = np.atleast_1d(ndimage.maximum(rest, labels, numbers)) if n else np.zeros(0)
    kept = numbers[(sizes >= SMALLEST_CONTACT) & (peaks >= LASTING * highest)]
    return np.isin(labels, kept), len(kept)


def _at_least(noise: float, step: float | None) -> float:
    """Return the noise of a reading, which is no less than that of its rounding."""
    return max(noise, (step or 0.0) / float(np.sqrt(12.0)))


class _Seen(NamedTuple):
    """Contacts in a frame, what of its load lies beyond the noise, and all of it."""

    contacts: int
    beyond: float
    total: float


def _seen(load: Stack, level: float, least: float) -> _Seen:
    return _Seen(_contacts(load, level), float(load[load > least].sum()), float(load.sum()))


def _contacts(above: Stack, level: float) -> int:
    from scipy import ndimage

    labels, n = ndimage.label(above > level, structure=np.ones((3, 3)))
    if level <= 0.0 or not n:
        return 0
    return int(np.count_nonzero(np.bincount(labels.ravel())[1:] >= SMALLEST_CONTACT))


def _ghosts(filled: Stack, idle: Stack, level: float, good: NDArray[np.bool_]) -> tuple[int, int]:
    """Return what `ghosts_in` does; cells that something always loads rest where others do.

    Ghosts make cells at rest few: it is the lower quarter that tells where.
    """
    if not good.any() or level <= 0.0:
        return 0, 0
    offset = float(np.quantile(idle[good], QUIET))
    return ghosts_in(filled, level, good, np.where(idle > offset + level, offset, idle))


class _Pace(NamedTuple):
    """Frames a second, the spread of their steps over the median, leaps, and the time they take."""

    rate_hz: float | None
    jitter: float | None
    n_leaps: int
    duration_s: float | None


def _pace(frames: Sequence[Frame]) -> _Pace:
    """Return how frames follow each other, by the device's clock where all have its time."""
    by_device = all(f.device_time_s is not None for f in frames)
    told = [(k, f.device_time_s if by_device else f.time_s) for k, f in enumerate(frames)]
    timed = [(k, time_s) for k, time_s in told if time_s is not None]
    places, times = np.array(timed, dtype=np.float64).reshape(-1, 2).T
    taken = np.diff(times)
    steps = taken / np.diff(places)  # frames without a time may lie between
    onward = steps[steps > 0]
    if len(onward) < 1:
        return _Pace(None, None, 0, None)
    usual = float(np.median(onward))
    passed = taken[(taken > 0) | (taken >= -OUT_OF_ORDER * usual)]
    duration_s = float(passed.sum())
    if np.count_nonzero(steps == 0.0) > IN_BURSTS * len(steps):
        usual = duration_s / float(places[-1] - places[0])
        return _Pace(1.0 / usual, None, 0, duration_s)
    jitter = float(np.median(np.abs(onward - usual))) * MAD_TO_SD / usual
    n_leaps = sum(is_leap(float(step), usual) for step in steps)
    return _Pace(1.0 / usual, jitter, n_leaps, duration_s)
