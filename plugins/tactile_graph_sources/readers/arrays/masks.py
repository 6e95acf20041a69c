"""Which cells are good, as yes and no beside the frames say: ``valid``, ``invalid``."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError
from tactile_graph_sources.readers.reading import Reading

_GOOD = {"valid", "is_valid", "good", "valid_cells", "good_cells"}
_BAD = {"invalid", "is_invalid", "masked", "bad", "invalid_cells", "bad_cells"}
_UNCLEAR = {"mask", "masks"}
"""True is a masked cell to NumPy, a good one to programs that cut out pictures."""
Outlines = Mapping[str, tuple[tuple[int, ...], np.dtype[Any]]]
Masks = Mapping[str, NDArray[Any]]
"""As they lie in their file: booleans, or 0 and 1."""


def masks_among(outlines: Outlines, load: Callable[[str], NDArray[Any]]) -> dict[str, NDArray[Any]]:
    """Return the arrays that are named as one of good or bad cells is, and hold yes and no alone.

    That are booleans, or 0 and 1 of one byte each, beside an array of numbers. Those that do not
    say what they mean by True are no masks unless they have its shape, or one axis.
    """
    named = {n for n in outlines if n.lower() in _GOOD | _BAD | _UNCLEAR}
    numbers = [s for n, (s, t) in outlines.items()
               if t.kind in "uif" and len(s) > 1 and n not in named]  # fmt: skip
    masks: dict[str, NDArray[Any]] = {}
    for name in sorted(named) if numbers else ():
        shape, dtype = outlines[name]
        unclear = name.lower() in _UNCLEAR
        unlike = unclear and len(shape) > 1 and not any(_fits(shape, of) for of in numbers)
        if dtype.kind not in "bui" or dtype.itemsize > 1 or not shape or unlike:
            continue
        mask = load(name)
        if mask.dtype.kind == "b" or np.isin(mask, (0, 1)).all():
            masks[name] = mask
    return masks


def refuse_unclear(where: str, shapes: Mapping[str, tuple[int, ...]], of: tuple[int, ...],
                   else_do: str) -> None:  # fmt: skip
    """Refuse a mask of which nothing says what it means by True; raises DataError.

    Parameters
    ----------
    where : str
    shapes : mapping
        Shape of each mask.
    of : tuple of int
        Shape of the array of the frames.
    else_do : str
    """
    for name, shape in shapes.items():
        if name.lower() in _UNCLEAR and _fits(shape, of):
            raise DataError(
                where,
                f"array {name!r} {shape} says which cells are good or which are not, "
                f"and nothing says which of the two; save it as valid, True where a cell is good, "
                f"in Python: numpy.savez('out.npz', frames=…, valid={name}), or valid=~{name}; "
                f"{else_do}",
            )


def without_invalid(
    reading: Reading, values: NDArray[Any], masks: Masks
) -> tuple[NDArray[Any], Masks]:
    """Return a stack as it lies in its file with NaN for the cells that masks say are none.

    It is told of each mask. Those that are not of its shape are returned, for `of_frames`.
    """
    others: dict[str, NDArray[Any]] = {}
    for name, mask in masks.items():
        if name.lower() in _UNCLEAR:
            reading.assume(f"array {name!r} left out")
            continue
        if not _fits(mask.shape, values.shape):
            others[name] = mask
            continue
        if mask.shape not in (values.shape, values.shape[-2:]):
            mask = mask[..., None]  # of frames along the last axis
        values = _without(reading, values, name, mask)
    return values, others


def of_frames(reading: Reading, what: str, frames: NDArray[Any], masks: Masks) -> NDArray[Any]:
    """Return matrices, shape (n, rows, columns), with NaN for cells that masks say are none.

    Cells of a mask may lie in a row; one with a value for each frame is of all its cells. An empty
    one says nothing, and numbers in a row that fit neither are passed by: they may be a list of
    cells, of which 0 and 1 are two.

    Raises
    ------
    DataError
        If a mask has no such shape, or it may be of frames as well as of cells.
    """
    for name, mask in masks.items():
        if not mask.size:
            continue
        found = list(_readings(reading, mask, frames.shape))
        if len(found) != 1:
            in_a_row = mask.ndim == 1 and mask.dtype.kind != "b" and not found
            if reading.told.sensor or in_a_row:
                reading.assume(f"array {name!r} left out")
                continue
            n, rows, columns = frames.shape
            why = "may be of frames or of cells" if found else "is of neither frames nor cells"
            raise DataError(
                str(reading.path),
                f"array {name!r} {mask.shape} {why}, of {what} ({n} frames of {rows} x {columns}); "
                f"save it with the shape ({rows}, {columns}) or ({n}, {rows}, {columns}), or name "
                "the frames with sensor to take all cells",
            )
        frames = _without(reading, frames, name, found[0])
    return frames


def _readings(
    reading: Reading, mask: NDArray[Any], shape: tuple[int, ...]
) -> Iterator[NDArray[Any]]:
    """Yield what a mask may say of matrices, in a shape that goes over all of them."""
    n, rows, columns = shape
    by_column = reading.told.order == "columns"
    mask = mask.squeeze() if mask.ndim > 2 else mask
    if mask.shape in (shape, shape[1:]):
        yield mask
    if mask.shape == (n,):
        yield mask[:, None, None]
    if mask.shape in ((rows * columns,), (n, rows * columns)):
        cells = (columns, rows) if by_column else (rows, columns)
        laid = mask.reshape(*mask.shape[:-1], *cells)
        yield laid.swapaxes(-1, -2) if by_column else laid


def _without(reading: Reading, values: NDArray[Any], name: str, mask: NDArray[Any]) -> NDArray[Any]:
    reading.heed(f"cells left out of which array {name!r} says so")
    good = mask == (name.lower() in _GOOD)
    return np.where(good, values, np.full((), np.nan, np.result_type(values, np.float32)))


def _fits(shape: tuple[int, ...], of: tuple[int, ...]) -> bool:
    """Return whether a mask of such a shape says of each cell of an array whether it is good."""
    return len(shape) > 1 and shape in (of, of[-2:], of[:2])
