"""What rises above the noise in a frame, and above the rest of its rows and columns."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_twin_of
from tactile_graph.errors import DataError, Degenerate
from tactile_graph.wires import Image
from tactile_graph_filters.readings.hot_lines import row_offsets
from tactile_graph_filters.readings.line_noise import cut_off_noise
from tactile_graph_filters.readings.ordered import in_order
from tactile_graph_likelihood.any_pad.observation.clump import NEAR
from tactile_graph_likelihood.any_pad.observation.frame_noise import frame_noise, noise_of_sorted
from tactile_graph_likelihood.any_pad.observation.learned_pad import Taught, taught
from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.single.readings import LARGEST
from tactile_graph_pads.pad import Pad

SHOWS = 4.0
"""Standard deviations of noise above zero from which on a reading is one."""

MOST_TOGETHER = 9
"""More are not counted: whether it is one, a few or many says whether it may be noise."""

EVERY = np.zeros((0, 0), np.bool_)
"""Stands for cells all of which are known."""
EVERY.setflags(write=False)


class Risen(NamedTuple):
    """Readings above the frame's zero, 0 where no more than noise, and what is more, in its unit.

    ``least`` is what a reading must exceed, of all elements or of each; ``shows`` where it does;
    ``taught`` what recordings say of the elements, if they do. A stuck element keeps its reading,
    which is none of a load.
    """

    above: Values
    least: float | Values
    shows: NDArray[np.bool_]
    zero: float
    taught: Taught | None


def risen(image: Image, pad: Pad, deviations: float = SHOWS) -> Risen:
    """Return what rises above the noise of an image.

    Parameters
    ----------
    image : Image
        In any quantity that rises with load.
    pad : Pad
        Where it was learned from recordings of this quantity, its offsets are taken off, its noise
        is taken, and its bad elements show nothing.
    deviations : float
        Standard deviations of noise that count as none.

    Raises
    ------
    DataError
        If a valid cell is not finite or beyond 1e100.
    Degenerate
        If no cell is valid.
    """
    its = taught(pad, image)
    if its is not None:
        return risen_by_element(image, its, deviations)
    zero, least, _, _, _, shows, above = rise_of(image, deviations, True)
    return Risen(above, least, shows, zero, None)


def risen_by_element(image: Image, its: Taught, deviations: float) -> Risen:
    """Return the same where something is known of each element."""
    values = np.ascontiguousarray(image.filled(0.0), dtype=np.float64)
    if not np.abs(values).max(initial=0.0) <= LARGEST:
        raise _unbounded()
    values = values - its.offset
    known = its.good if image.valid is None else its.good & image.valid
    if not known.any():
        raise _untold()
    noise = frame_noise(values[known])
    least: float | Values = float(max(deviations * noise.sigma, 0.5 * noise.step))
    if its.noise is not None:
        least = np.maximum(deviations * its.noise, max(its.least, 0.5 * noise.step))
    above = values - noise.zero
    shows = above > least
    kept = shows & (its.good | its.stuck)
    if image.valid is not None:
        kept = kept & image.valid
    return Risen(np.where(kept, above, 0.0), least, shows & known, noise.zero, its)


def _untold() -> Degenerate:
    return Degenerate("no cell of the image is valid, so nothing says what is touched")


def _unbounded() -> DataError:
    return DataError("image", f"readings must be finite and at most {LARGEST:g}")


def rise_of(
    image: Image, deviations: float, wanted: bool
) -> tuple[float, float, int, int, float, NDArray[np.bool_], Values]:
    """Return what `rising` does of an image of whose elements nothing is known.

    Raises
    ------
    DataError
        If a valid cell is not finite or beyond 1e100.
    Degenerate
        If no cell is valid.
    """
    values, known = np.ascontiguousarray(image.values, dtype=np.float64), EVERY
    values.setflags(write=False)
    if image.valid is None:
        readings = values.ravel()
    else:
        known = np.ascontiguousarray(image.valid)
        known.setflags(write=False)
        readings = values[known]
        if not readings.size:
            raise _untold()
    bounded, *found = rising.direct(values, known, in_order(readings), float(deviations), wanted)
    if not bounded:
        raise _unbounded()
    return found  # type: ignore[return-value]


def _together_plain(shows: NDArray[np.bool_]) -> int:
    """Return the most of some cells, shape (rows, columns), within `NEAR` of one of them."""
    if not shows.any():
        return 0
    wide = np.pad(shows.astype(np.int64), NEAR)
    window = (2 * NEAR + 1, 2 * NEAR + 1)
    counts = np.lib.stride_tricks.sliding_window_view(wide, window).sum(axis=(2, 3))
    return min(int(counts[shows].max(initial=0)), MOST_TOGETHER)


@compiled_twin_of(_together_plain)
def together(shows):  # type: ignore[no-untyped-def]
    """Do the same in loops, which end as soon as there are enough."""
    rows, columns = shows.shape
    most = 0
    for r in range(rows):
        for c in range(columns):
            if not shows[r, c]:
                continue
            count = 0
            for i in range(max(0, r - NEAR), min(rows, r + NEAR + 1)):
                for j in range(max(0, c - NEAR), min(columns, c + NEAR + 1)):
                    count += shows[i, j]
            if count >= MOST_TOGETHER:
                return MOST_TOGETHER
            most = max(most, count)
    return most


def _rising_plain(
    values: Values, known: NDArray[np.bool_], sample: Values, deviations: float, wanted: bool
) -> tuple[bool, float, float, int, int, float, NDArray[np.bool_], Values]:
    """Return what rises above the noise.

    Parameters
    ----------
    values : ndarray, shape (rows, columns)
    known : ndarray of bool, the same shape
        The cells that count; `EVERY` for all.
    sample : ndarray, shape (N,)
        Of their values, in ascending order.
    deviations : float
        Standard deviations of noise that count as none.
    wanted : bool
        Whether the last is asked for.

    Returns
    -------
    bounded : bool
        Whether values are finite and at most 1e100; the others say nothing where they are not.
    zero, least : float
        What untouched elements read, and what a reading must rise above that.
    count, near : int
        Cells that do, and as of `together`.
    most : float
        How far the largest rises, 0 where none does.
    shows : ndarray of bool, shape (rows, columns)
    above : ndarray, shape (rows, columns)
        How far they rise, in rows and columns that rest higher from there; 0 where no more than
        noise; if it is not wanted, of shape (0, 0).
    """
    kept = values if known is EVERY else np.where(known, values, 0.0)
    if not np.abs(kept).max(initial=0.0) <= LARGEST:
        return False, 0.0, 0.0, 0, 0, 0.0, EVERY, np.zeros((0, 0))
    zero, sigma, step = noise_of_sorted.reference(sample)
    if sigma == 0.0:
        sigma = cut_off_noise.reference(kept, known, sample, zero, step)
    least = max(deviations * sigma, 0.5 * step)
    down = row_offsets.reference(values, known, zero, sigma, step)
    across = row_offsets.reference(values.T, known.T, zero, sigma, step)
    above = kept - zero - down[:, None] - across
    shows = above > least
    if known is not EVERY:
        shows &= known
    above = np.where(shows, above, 0.0)
    near, most = _together_plain(shows), float(above.max(initial=0.0))
    count = int(np.count_nonzero(shows))
    return True, zero, least, count, near, most, shows, above if wanted else np.zeros((0, 0))


@compiled_twin_of(_rising_plain)
def rising(values, known, sample, deviations, wanted):  # type: ignore[no-untyped-def]
    """Do the same in loops."""
    (rows, columns), every = values.shape, known.size == 0
    shows = np.empty((rows, columns), np.bool_)
    above = np.empty((rows, columns) if wanted else (0, 0))
    unbounded = count = 0
    for i in range(rows):
        for j in range(columns):
            unbounded += (every or known[i, j]) and not abs(values[i, j]) <= LARGEST
    if unbounded > 0:
        return False, 0.0, 0.0, 0, 0, 0.0, shows, above
    zero, sigma, step = noise_of_sorted(sample)
    if sigma == 0.0:
        sigma = cut_off_noise(values, known, sample, zero, step)
    least, most = max(deviations * sigma, 0.5 * step), 0.0
    down = row_offsets(values, known, zero, sigma, step)
    across = row_offsets(values.T, known.T, zero, sigma, step)
    for i in range(rows):
        for j in range(columns):
            rise = values[i, j] - zero - down[i] - across[j]
            its = (every or known[i, j]) and rise > least
            shows[i, j] = its
            if its:
                count += 1
                most = max(most, rise)
            if wanted:
                above[i, j] = rise if its else 0.0
    return True, zero, least, count, together(shows), most, shows, above
