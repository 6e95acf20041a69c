"""``Told``: what the user says about a recording where the file itself cannot."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from numpy.typing import NDArray

from tactile_graph.errors import DataError
from tactile_graph_sources.readers.names import NOTHING_TOLD, ColumnsTold

MOST_CELLS = 4_000_000  # a damaged header must not ask for all memory there is


@dataclass(frozen=True, slots=True)
class Told:
    """The settings of a recording; None where the file is to be believed.

    ``order``, ``transpose`` and ``flip`` say how a frame's cells are turned once they are read,
    ``skip`` how many frames are left out in front.
    """

    rows: int | None = None
    columns: int | None = None
    pitch_cm: tuple[float, float] | None = None
    origin_cm: tuple[float, float] | None = None
    quantity: str | None = None
    sensor: str = ""
    of_columns: ColumnsTold = NOTHING_TOLD
    order: str = "rows"
    transpose: bool = False
    flip: str = ""
    skip: int = 0

    def laid_out(self, cells: NDArray[Any], rows: int, columns: int) -> NDArray[Any]:
        """Return cells in a row as a matrix, by the order in which they come."""
        if self.order == "columns":
            return cells.reshape(columns, rows).T
        return cells.reshape(rows, columns)

    def turned(self, matrix: NDArray[Any]) -> NDArray[Any]:
        """Return a matrix as the pad is to be seen."""
        if self.transpose:
            matrix = matrix.T
        if self.flip in ("rows", "both"):
            matrix = matrix[::-1]
        return matrix[:, ::-1] if self.flip in ("columns", "both") else matrix

    def agree(self, where: str, rows: int, columns: int) -> None:
        """Refuse a shape that is not the one told, or is none at all.

        Raises
        ------
        DataError
            If the file's shape is empty, absurdly large, or not what the settings say.
        """
        if min(rows, columns) < 1 or rows * columns > MOST_CELLS:
            raise DataError(
                where,
                f"its frames are said to have {rows} x {columns} cells; "
                f"at least 1 x 1 and at most {MOST_CELLS} cells can be true",
            )
        told_rows, told_columns = self.rows or rows, self.columns or columns
        if (told_rows, told_columns) != (rows, columns):
            raise DataError(
                where,
                f"its frames have {rows} rows and {columns} columns, the settings say "
                f"rows={self.rows}, columns={self.columns}; leave them out",
            )

    def shape_of(self, where: str, n_values: int) -> tuple[int, int]:
        """Return rows and columns of a frame that comes as ``n_values`` in a row.

        Raises
        ------
        DataError
            If the settings do not fit, or nothing is told and the number is no square.
        """
        rows, columns = self.rows, self.columns
        side = round(n_values**0.5)
        if rows is None and columns is None and side * side == n_values:
            rows = columns = side
        elif rows is None and columns is not None:
            rows = n_values // columns
        elif columns is None and rows is not None:
            columns = n_values // rows
        if rows is None or columns is None or rows * columns != n_values or n_values == 0:
            said = f"rows={self.rows}, columns={self.columns}" if rows or columns else "nothing"
            raise DataError(
                where,
                f"a frame is {n_values} values in a row, and the settings say {said} of its shape; "
                "give rows and columns whose product is that number",
            )
        return rows, columns
