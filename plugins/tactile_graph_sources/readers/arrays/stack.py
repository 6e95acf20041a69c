"""An array as a stack of matrices, by its axes and what the settings say."""

from __future__ import annotations

import math
from math import isqrt
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError
from tactile_graph_sources.readers.reading import Reading
from tactile_graph_sources.readers.tables.evidence import row_lengths

SMALLEST_SURE_SQUARE, LEAST_FRAMED = 36, 16
LONGEST_UNTOLD = 4
MOST_CHANNELS = 4
MOST_LAST, FEWEST_BESIDE = 5, 6
"""Length of a last axis that may be that of channels, and those of the other two beside it."""
FEWEST_ALONG, MOST_ALONG = 4, 100
ALIKE, UNLIKE = 2.5, 4.0
"""Times the difference of neighbours along one axis that those along another are, at most where
they are axes of one kind, and at least where not."""
VERY_ALIKE, CLEARER = 1.5, 2.0
"""The same where neither is so: at most, and times more than the axes of the other reading."""
MAD_TO_SD = 1.4826
_AS_REAL = "such, in Python: numpy.save('out.npy', array.{})"
ASSUMED_FIRST = "frames assumed to lie along the first axis, {} of {} x {}"
ASSUMED_ONE = "{} lines of {} values assumed to be the rows of one matrix"
LAST_IS_TIME = 4
"""Times the other two: a last axis longer than that is more likely the frames'."""


Axes = Literal["asked", "outline", "known"]
"""Whether frames may lie along another axis than the first: the values are asked, the shape alone
is, as of an array that is not read yet, or it is known that they do not."""


def stack_of(
    reading: Reading, array: NDArray[Any], name: str, axes: Axes = "asked"
) -> NDArray[Any]:
    """Return the array as matrices along its first axis, shape (N, rows, columns); a view.

    Parameters
    ----------
    reading : Reading
        Its settings ``rows`` and ``columns`` decide where the axes could be read two ways: an
        (N, rows x columns) array is N frames, in the ``order`` that is told, and one of
        (rows x columns, N) or (rows, columns, N) is turned.
    array : ndarray
        Numbers on 2 or 3 axes.
    name : str
        What messages call it.
    axes : str
        Whether it is ``asked`` which axis is the frames'.

    Raises
    ------
    DataError
        If it holds no numbers, no frame, or has other axes.
    """
    where = str(reading.path)
    if fields := array.dtype.names:
        field = next((n for n in fields if array.dtype[n].shape), fields[0])
        raise DataError(
            where,
            f"{name} has fields ({', '.join(fields)}); save the one with the cells alone: "
            f"numpy.save('out.npy', array[{field!r}])",
        )
    if array.dtype.kind not in "buif":
        told = f"{name} holds {array.dtype}, not real numbers; save it as {_AS_REAL}"
        raise DataError(where, told.format("real" if array.dtype.kind == "c" else "astype(float)"))
    rows, columns = reading.told.rows, reading.told.columns
    if array.ndim > 3:
        array = without_single_axes(array)
    if array.ndim == 3 and axes != "known":
        _refuse_channels(reading, array, name, axes)
    if rows is not None and columns is not None:
        n_cells = rows * columns
        if array.ndim == 2 and array.shape != (rows, columns) and n_cells in array.shape:
            lines = array if array.shape[1] == n_cells else array.T
            by_column = reading.told.order == "columns"
            array = lines.reshape(-1, *((columns, rows) if by_column else (rows, columns)))
            array = array.transpose(0, 2, 1) if by_column else array
        elif array.ndim == 3 and array.shape[:2] == (rows, columns) != array.shape[1:]:
            array = np.moveaxis(array, -1, 0)
        elif axes == "asked" and array.shape == (rows, rows, rows):
            array = _of_equal_sides(reading, array)
    if array.ndim in (2, 3) and 0 in array.shape:
        raise DataError(where, f"{name} has shape {array.shape}: it holds no cell")
    if array.ndim == 0:
        raise DataError(where, f"{name} is one number, no matrix")
    if array.ndim not in (2, 3):
        raise DataError(
            where,
            f"{name} has shape {array.shape}; a matrix or matrices along the first axis are read: "
            f"save it as {_as_matrices(array.shape)}",
        )
    if rows is None or columns is None:
        if array.ndim == 2:
            _refuse_frames_in_a_row(where, array, name)
            if min(array.shape) > 1 and axes != "known":
                reading.assume(ASSUMED_ONE.format(*array.shape))
        elif axes != "known":
            _ask_axes(reading, array, name, axes)
    told = "as rows and columns say" if rows and columns else "a matrix along each first index"
    reading.recognised(f"{name} of shape {array.shape}, {told}")
    array = array[None] if array.ndim == 2 else array
    reading.told.agree(where, array.shape[1], array.shape[2])
    return array


def _as_matrices(shape: tuple[int, ...]) -> str:
    """Return how an array of one axis, or of more than three, becomes matrices."""
    if len(shape) < 4:
        return "array.reshape(-1, rows, columns)"
    if shape[-1] <= MOST_CHANNELS:
        return one_of_channels("...,", -1)
    if shape[-3] <= MOST_CHANNELS:
        return one_of_channels(f"{':, ' * (len(shape) - 3)}".rstrip(), len(shape) - 3)
    return f"array.reshape(-1, {shape[-2]}, {shape[-1]}), or each sensor alone"


def one_of_channels(before: str, axis: int) -> str:
    """Return what to save of channels along an axis, with what stands before it in brackets."""
    return (
        f"array[{before} channel] with the number of the channel that is measured, or of colours "
        f"their mean, array.mean(axis={axis})"
    )


def without_single_axes(array: NDArray[Any]) -> NDArray[Any]:
    """Return an array without the axes of one channel: (N, rows, columns, 1), (N, 1, rows, …)."""
    extra = [k for k in range(1, array.ndim) if array.shape[k] == 1]
    return array.squeeze(tuple(extra[: array.ndim - 3])) if array.ndim > 3 and extra else array


def _axes_told(array: NDArray[Any]) -> str:
    """Return which axis the values say is the frames': ``first``, ``last``, empty where neither.

    Neighbours along rows and along columns differ alike, those along time more or less than they.
    Of each axis' differences what every cell shows, which noise gives along all of them, is left
    out.
    """
    if min(array.shape) < FEWEST_ALONG:
        return ""
    values = np.nan_to_num(array[:MOST_ALONG, :MOST_ALONG, :MOST_ALONG].astype(np.float64))
    values = np.clip(values, -1e30, 1e30)
    along = [np.abs(np.diff(values, axis=k)) for k in range(3)]
    noise = MAD_TO_SD * min(float(np.median(steps)) for steps in along)
    apart = [_beyond(steps, noise) for steps in along]
    first, middle, last = (max(d, noise / 2.0, 1e-30) for d in apart)
    if _fits(first, middle, last) and min(apart[:2]) > noise:
        return "last"
    return "first" if _fits(last, middle, first) and min(apart[1:]) > noise else ""


def _fits(one: float, other: float, time: float) -> bool:
    """Return whether two axes are more likely those of a frame than the second one and the third.

    Parameters
    ----------
    one, other, time : float
        How much neighbours along each axis differ.
    """
    across, along = _ratio(one, other), _ratio(other, time)
    unlike = time > UNLIKE * max(one, other) or time < min(one, other) / UNLIKE
    return (across < ALIKE and unlike) or (across < VERY_ALIKE and along > CLEARER * across)


def _ratio(one: float, other: float) -> float:
    return max(one, other) / min(one, other)


def _beyond(steps: NDArray[Any], noise: float) -> float:
    """Return the root mean square of differences, less that of noise."""
    return math.sqrt(max(0.0, float(np.mean(steps**2)) - noise**2))


def _refuse_frames_in_a_row(where: str, array: NDArray[Any], name: str) -> None:
    """Refuse a matrix whose rows or columns may be frames; the reading is named."""
    lines, cells = shape = array.shape
    side = isqrt(cells)
    square = side * side == cells and lines not in (1, cells)
    long = max(shape) > LONGEST_UNTOLD * min(shape)
    for what, in_a_row in (("row", array), ("column", array.T)):
        lengths = row_lengths(in_a_row[:MOST_ALONG].astype(np.float64)) if lines > 1 else []
        if lengths and in_a_row.shape[1] >= LEAST_FRAMED:
            (n, m), each = lengths[0], in_a_row.shape[0]
            raise DataError(
                where,
                f"{name} has shape {shape}: one matrix, or {each} frames of {n} x {m} with "
                f"their cells in a {what}, as they lie together; give rows and columns",
            )
    if lines > 1 and ((square and cells >= SMALLEST_SURE_SQUARE) or long):
        as_frames = f"{lines} frames of {side} x {side}" if square else f"{lines} frames"
        raise DataError(
            where,
            f"{name} has shape {shape}: one matrix, or {as_frames} with their cells in a row; "
            "give rows and columns",
        )


def _of_equal_sides(reading: Reading, array: NDArray[Any]) -> NDArray[Any]:
    """Return a stack of three equal sides with its frames first, as its values say; it is told."""
    n, told = len(array), _axes_told(array)
    if told == "last":
        reading.assume(f"frames taken to lie along the last axis of {n}, as the values say")
        return np.moveaxis(array, -1, 0)
    if n > 1 and not told:
        reading.assume(ASSUMED_FIRST.format(n, n, n))
    return array


def _refuse_channels(reading: Reading, array: NDArray[Any], name: str, axes: Axes) -> None:
    """Refuse a stack whose short last axis may be that of colours or channels of one frame.

    Rows or columns that are told decide, if they are those of the matrices alone.
    """
    n, rows, columns = shape = array.shape
    told = reading.told
    if told.agrees(rows, columns) and not told.agrees(n, rows):
        return
    alike = max(n, rows) <= LONGEST_UNTOLD * min(n, rows)
    colours = columns in (3, 4) and min(n, rows) > 4 and told.shape is None
    few = 1 < columns <= MOST_LAST and min(n, rows) >= FEWEST_BESIDE and alike and axes == "asked"
    if colours or (few and _axes_told(array) != "first"):
        raise DataError(
            str(reading.path),
            f"{name} has shape {shape}: {n} frames of {rows} x {columns}, or a picture of "
            f"{columns} colours or channels; of these save {one_of_channels('...,', -1)}; of "
            f"{columns} frames of {n} x {rows} save numpy.moveaxis(array, -1, 0); else give rows "
            "and columns",
        )


def _ask_axes(reading: Reading, array: NDArray[Any], name: str, axes: Axes) -> None:
    """Refuse a stack whose frames as likely lie along the last axis; what nothing says is told."""
    where, shape = str(reading.path), array.shape
    n, rows, columns = shape
    last_is_time = (n == rows != columns) or columns > LAST_IS_TIME * max(n, rows)
    told = "" if axes == "outline" else _axes_told(array)
    last_is_time = last_is_time or told == "last"
    if last_is_time and min(n, rows) > 1:
        raise DataError(
            where,
            f"{name} has shape {shape}: {n} frames of {rows} x {columns}, or {columns} frames of "
            f"{n} x {rows} along the last axis; give rows and columns",
        )
    if axes == "asked" and not told and min(n, rows, columns) > 1:
        reading.assume(ASSUMED_FIRST.format(n, rows, columns))
