"""Find NaN and infinity in an image, or made of it, and refuse it naming the cell."""

from __future__ import annotations

from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later
from tactile_graph.errors import DataError, Degenerate
from tactile_graph.wires import Image


@compiled_later
def all_finite(values):  # type: ignore[no-untyped-def]
    """Return whether no value is NaN or infinite."""
    bad = 0
    for i in range(values.shape[0]):
        row = values[i]
        for j in range(values.shape[1]):
            bad += row[j] - row[j] != 0  # NaN for NaN and infinity
    return bad == 0


def finite(values: NDArray[Any]) -> bool:
    """Return whether all values are numbers, of whatever type; fast where they are doubles."""
    return all_finite.call(values) if values.dtype.char == "d" else bool(np.isfinite(values).all())


def refuse_nan(image: Image, *, infinite: bool = False) -> None:
    """Raise if a valid cell holds NaN.

    Parameters
    ----------
    image : Image
    infinite : bool
        Whether infinity is refused as well.

    Raises
    ------
    DataError
        Naming row and column (from 0) of the first such cell, and how many there are.
    """
    bad = ~np.isfinite(image.values) if infinite else np.isnan(image.values)
    if image.valid is not None:
        bad &= image.valid
    n_bad = int(np.count_nonzero(bad))
    if n_bad:
        row, column = np.argwhere(bad)[0].tolist()
        others = f" (and {n_bad - 1} more cells)" if n_bad > 1 else ""
        raise DataError(
            f"image, row {row}, column {column}",
            f"must be a number, got {image.values[row, column]}{others};"
            " a missing or broken cell must be marked invalid",
        )


def require_finite(image: Image) -> None:
    """Raise if a valid cell holds NaN or infinity; fast where none does.

    Raises
    ------
    DataError
        As `refuse_nan`.
    """
    if not finite(image.values):
        refuse_nan(image, infinite=True)


def refuse_unbounded(image: Image, what: str) -> NoReturn:
    """Say why ``what``, made of an image, is not finite.

    Raises
    ------
    DataError
        If a valid cell holds NaN or infinity.
    Degenerate
        If all are finite: the result is then too large for a number.
    """
    refuse_nan(image, infinite=True)
    size = float(np.abs(image.filled()).max())
    raise Degenerate(f"{what} is too large for a number: values reach {size:.3g}")


def require_summable(image: Image, readings: NDArray[Any]) -> None:
    """Raise if readings of an image, or their moments, add up to no number.

    Raises
    ------
    DataError, Degenerate
        As `refuse_unbounded`.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        total = float(np.abs(readings).sum())
    if not np.isfinite(total * max(image.shape)):
        refuse_unbounded(image, "the load of the footprint, or its moment")
