"""``Told``: what the user says about a recording where the file itself cannot."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from numpy.typing import NDArray

from tactile_graph.errors import DataError
from tactile_graph.foreign_text import pasted
from tactile_graph.pipeline.document import is_plain
from tactile_graph_sources.readers.words.names import NOTHING_TOLD, ColumnsTold

if TYPE_CHECKING:
    from tactile_graph_pads.told_grid import ToldGrid

_LIKELY = re.compile(
    r"(\d+) x (\d+)(?: cells)?(?=, as (?:they lie\)|cells lie together))|could be (\d+) x (\d+)"
)
_SETTINGS = (
    "rows", "columns", "sensor", "frame_column", "time_column", "value_column", "cells",
    "time_format",
)  # fmt: skip
_SETTING = rf"(?:{'|'.join(_SETTINGS)})\b(?!=)"
_ASKED = re.compile(
    rf"\b(?:give(?: the settings)?|name one with)\s+({_SETTING}(?:(?:,| and)\s+{_SETTING})*)"
)
_SUCH_AS = re.compile(rf"such as ({'|'.join(_SETTINGS)})=(?:'([^']*)'|([^\s,;()]+))")
"""Where a refusal names settings, which are common words too: "say which columns are cells"."""
MOST_CELLS = 4_000_000  # a damaged header must not ask for all memory there is


@dataclass(frozen=True, slots=True)
class Told:
    """The settings of a recording; None where the file is to be believed.

    ``order``, ``transpose`` and ``flip`` say how a frame's cells are turned once they are read,
    ``skip`` how many frames are left out in front, ``first_cell`` the number of the first row and
    column where a table numbers them, ``pads`` what pad files say of their grids,
    ``missing`` the number that stands for no reading.
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
    first_cell: int | None = None
    pads: tuple[ToldGrid, ...] = ()
    missing: float | None = None

    @classmethod
    def of(cls, columns_told: ColumnsTold = NOTHING_TOLD, **settings: Any) -> Told:
        """Return what settings say, by their names; a pitch may be one number.

        Raises
        ------
        UsageError, RecordError
            If there is no such pad, or its file is wrong.
        """
        pitch = settings.get("pitch_cm")
        if isinstance(pitch, int | float):
            settings["pitch_cm"] = (float(pitch), float(pitch))
        if (pad := settings.pop("pad", None)) is not None:
            from tactile_graph_pads.told_grid import told_grid

            one = isinstance(pad, str | Mapping)
            settings["pads"] = tuple(told_grid(p) for p in ([pad] if one else pad))
        return cls(of_columns=columns_told, **settings)

    @property
    def shape(self) -> tuple[int, int] | None:
        """Rows and columns of a frame; None unless both are told."""
        if self.rows is None or self.columns is None:
            return None
        return self.rows, self.columns

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

    def with_said(self, rows: int | None, columns: int | None) -> Told:
        """Return the settings with a shape that the file says where they say none."""
        return replace(self, rows=self.rows or rows, columns=self.columns or columns)

    def agrees(self, rows: int, columns: int) -> bool:
        """Return whether frames may have this shape, by either or both."""
        return self.rows in (None, rows) and self.columns in (None, columns)

    def fits(self, n_values: int) -> tuple[int, int] | None:
        """Return rows and columns of so many values, by either or both; None where none fit."""
        rows = self.rows or n_values // (self.columns or 1)
        columns = self.columns or (n_values // rows if rows else 0)
        return (rows, columns) if rows * columns == n_values > 0 else None

    def misfit(self, n_values: int) -> str:
        """Return what to say of values in a row that the told shape does not fit."""
        said = (
            f"rows={self.rows}, columns={self.columns}" if self.rows or self.columns else "nothing"
        )
        return (
            f"a frame is {n_values} values in a row, and the settings say {said} of its shape; "
            "give rows and columns whose product is that number, or say which columns are cells, "
            "such as cells=2-65"
        )


def _in_yaml(text: str) -> str:
    """Return a text as YAML that is read as that text: in quotes where it looks like a number."""
    return text if is_plain(text) else json.dumps(text, ensure_ascii=False)


def as_typed(what: str, sensors: Sequence[str] = ()) -> str:
    """Return how the settings that a refusal asks for are typed on a command line; empty if none.

    What the shape may be by its words, and the first of ``sensors``, is put in.
    """
    such_as = {m[1]: m[2] or m[3] for m in _SUCH_AS.finditer(what)}
    asked = {word for m in _ASKED.finditer(what) for word in re.findall(_SETTING, m[1])}
    likely = _LIKELY.search(what)
    rows, columns = [g for g in likely.groups() if g] if likely else ("…", "…")
    sensor = _in_yaml(sensors[0]) if sensors else "…"
    values = {"rows": rows, "columns": columns, "sensor": sensor, **such_as}
    pairs = [f"{s}={values.get(s, '…')}" for s in _SETTINGS if s in asked or s in such_as]
    typed = [f"--with {pasted(p) if '…' not in p else p}" for p in pairs]
    return f" (as typed: {' '.join(typed)})" if typed else ""
