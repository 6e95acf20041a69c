"""Which cells are good, as a boolean array beside the frames says it: ``valid``, ``invalid``."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError
from tactile_graph_sources.readers.reading import Reading

_GOOD = {"valid", "is_valid", "good"}
_BAD = {"invalid", "is_invalid", "masked", "bad"}
_UNCLEAR = {"mask", "masks"}
"""True is a masked cell to NumPy, a good one to programs that cut out pictures."""
Outlines = Mapping[str, tuple[tuple[int, ...], np.dtype[Any]]]


def masks_among(outlines: Outlines) -> list[str]:
    """Return the names of boolean arrays that say of the cells of others whether they are good."""
    shapes = [s for s, dtype in outlines.values() if dtype.kind in "uif"]
    return [
        name
        for name, (shape, dtype) in outlines.items()
        if dtype.kind == "b"
        and name.lower() in _GOOD | _BAD | _UNCLEAR
        and any(_fits(shape, of) for of in shapes)
    ]


def refuse_unclear(where: str, outlines: Outlines, else_do: str) -> None:
    """Refuse a mask of which nothing says what it means by True; raises DataError."""
    for name in masks_among(outlines):
        if name.lower() in _UNCLEAR:
            raise DataError(
                where,
                f"array {name!r} {outlines[name][0]} says which cells are good or which are not, "
                f"and nothing says which of the two; save it as valid, True where a cell is good, "
                f"in Python: numpy.savez('out.npz', frames=…, valid={name}), or valid=~{name}; "
                f"{else_do}",
            )


def without_invalid(
    reading: Reading, values: NDArray[Any], masks: Mapping[str, NDArray[np.bool_]]
) -> NDArray[Any]:
    """Return a stack with NaN for the cells that masks say are none; it is told of each mask."""
    for name, mask in masks.items():
        if name.lower() in _UNCLEAR or not _fits(mask.shape, values.shape):
            reading.assume(f"array {name!r} left out")
            continue
        good = mask if name.lower() in _GOOD else ~mask
        if mask.shape not in (values.shape, values.shape[-2:]):
            good = good[..., None]  # of frames along the last axis
        values = np.where(good, values, np.full((), np.nan, np.result_type(values, np.float32)))
        reading.assume(f"cells left out of which array {name!r} says so")
    return values


def _fits(shape: tuple[int, ...], of: tuple[int, ...]) -> bool:
    """Return whether a mask of such a shape says of each cell of an array whether it is good."""
    return len(shape) > 1 and shape in (of, of[-2:], of[:2])
