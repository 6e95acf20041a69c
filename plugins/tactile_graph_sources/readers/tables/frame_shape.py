"""The shape of frames whose cells come in a row: told, square, or asked for."""

from __future__ import annotations

from math import isqrt
from typing import NamedTuple

from tactile_graph_sources.readers.tables.evidence import (
    CLEAR,
    Numbers,
    row_length_clarity,
    row_lengths,
)
from tactile_graph_sources.readers.words.told import Told


class Shaped(NamedTuple):
    """Rows and columns, what of them is assumed, and without them what to ask."""

    shape: tuple[int, int] | None
    assumed: tuple[str, ...] = ()
    trouble: str = ""


def shape_of_cells(cells: Numbers, told: Told) -> Shaped:
    """Return rows and columns of frames, by the settings or by the cells themselves.

    Parameters
    ----------
    cells : ndarray, shape (frames, cells)
    told : Told

    Returns
    -------
    Shaped
        A square number of cells is a square, unless they lie together in rows of another length.
    """
    width = cells.shape[1]
    if told.rows is not None or told.columns is not None:
        shape = told.fits(width)
        return Shaped(shape, (), "" if shape else told.misfit(width))
    lengths, side = row_lengths(cells), isqrt(width)
    likely = f"{lengths[0][0]} x {lengths[0][1]}" if lengths else ""
    if side * side != width or width < 4:
        asked = f"; as they lie they could be {likely}" if likely else ""
        return Shaped(
            None,
            (),
            f"a frame is {width} values in a row, and nothing says its shape; give rows and "
            f"columns whose product is that number{asked}",
        )
    clear = row_length_clarity(cells, side) < CLEAR
    if lengths and lengths[0][1] != side and not clear:
        return Shaped(
            None,
            (),
            f"a frame is {width} values in a row: {side} x {side} by their number, {likely} by "
            "which cells lie together; give rows and columns",
        )
    return Shaped((side, side), () if clear else (f"frames assumed to be square, {side} x {side}",))
