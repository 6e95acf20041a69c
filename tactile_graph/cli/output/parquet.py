"""Write a table as a Parquet file: columns of types and units, a group of rows at a time."""

from __future__ import annotations

import io
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

from tactile_graph.api.result import Result
from tactile_graph.engine.blocks.block import Block
from tactile_graph.engine.tables.columns import Column
from tactile_graph.engine.tables.table import Table, units_of
from tactile_graph.errors import UsageError
from tactile_graph.exporter import Export, Exporter, Writer, check_plain
from tactile_graph.files import left_of, said, uninterrupted
from tactile_graph.part_files import part_of

ROWS_A_GROUP = 10_000
FRAME = "frame"
"""The column of numbers that frames are counted by."""
MISSING = "Parquet files need pyarrow: pip install 'tactile-graph[parquet]'"


def pyarrow() -> Any:
    """Return the library that writes Parquet files.

    Raises
    ------
    UsageError
        If it is not installed.
    """
    try:
        import pyarrow
        import pyarrow.parquet
    except ImportError:
        raise UsageError(MISSING) from None
    return pyarrow


class ParquetFile:
    """A Parquet file under way; it stands under its name when it is closed, whole.

    Parameters
    ----------
    output : str
        Path. Until the end rows go to a hidden ``.part`` beside it.
    table : Table
    """

    keeps = False
    """Whether what is written stays where a run ends early: it stands when it is closed."""

    def __init__(self, output: str, table: Table) -> None:
        if output == "-":
            raise UsageError("-o -: a Parquet file cannot go to stdout; give a name")
        self._pyarrow = pyarrow()
        self.output = output
        self.broken = False
        """Whether rows could not be written; then nothing is left."""
        self._target = Path(os.path.realpath(output))
        self._part = part_of(self._target)
        self._table = table
        self._cells: dict[str, list[Any]] = {column.key: [] for column in table.columns}
        self._n_rows = 0
        self._writer: Any = None
        self._quantity = "raw"

    def write(self, result: Result) -> None:
        """Take in a frame's rows."""
        rows = [*self._table.rows(result)]
        cells = {key: [row.get(key) for row in rows] for key in self._cells}
        self._add(cells, len(rows), result.frame.image.quantity)

    def write_block(self, block: Block[Result]) -> None:
        """Take in the rows of several frames."""
        cells = self._table.of_block(block)
        n = len(next(iter(cells.values())))
        self._add(cells, n, block.frames.images.quantity)

    def _add(self, cells: dict[str, list[Any]], n: int, quantity: str) -> None:
        if self._writer is None and not self._n_rows:
            self._quantity = quantity
        for key, column in self._cells.items():
            column += cells[key]
        self._n_rows += n
        if self._n_rows >= ROWS_A_GROUP:
            self._flush()

    def close(self) -> None:
        """Write what is left, and give the file its name."""
        if self.broken:
            return
        self._flush()
        with self._whole():
            self._writer.close()
            os.replace(self._part, self._target)

    @contextmanager
    def _whole(self) -> Iterator[None]:
        """Leave nothing behind where anything is raised."""
        try:
            with uninterrupted(), said(self.output, left_of(self._target)):
                yield
        except BaseException:
            self.broken = True
            self._part.unlink(missing_ok=True)
            raise

    def _flush(self) -> None:
        arrow = self._pyarrow
        with self._whole():
            if self._writer is None:
                units = units_of(self._table, self._quantity)
                fields = [_field(arrow, c, units.get(c.key, "")) for c in self._table.columns]
                self._schema = arrow.schema(fields)
                self._writer = _writer(arrow, str(self._part), self._schema)
            cells = {c.key: _plain(self._cells[c.key], c.kind) for c in self._table.columns}
            self._writer.write_table(arrow.table(cells, schema=self._schema))
        self._cells = {key: [] for key in self._cells}
        self._n_rows = 0


def _writer(arrow: Any, where: str | BinaryIO, schema: Any) -> Any:
    """Return what writes a file; a dictionary of numbers that hardly come twice is not tried."""
    repeating = [f.name for f in schema if not (arrow.types.is_floating(f.type) or f.name == FRAME)]
    return arrow.parquet.ParquetWriter(where, schema, use_dictionary=repeating or False)


def _field(arrow: Any, column: Column, unit: str) -> Any:
    kind = column.kind
    if issubclass(kind, bool | np.bool_):
        of = arrow.bool_()
    elif issubclass(kind, int | np.integer):
        of = arrow.int64()
    elif issubclass(kind, float | np.floating):
        of = arrow.float64()
    else:
        of = arrow.string()
    return arrow.field(column.key, of, metadata={"unit": unit} if unit else None)


def _plain(cells: list[Any], kind: type) -> list[Any]:
    if issubclass(kind, bool | int | float | np.generic):
        return cells
    return [None if cell is None else str(cell) for cell in cells]


def _check(name: str) -> None:
    pyarrow()
    check_plain(name)


def _opened(export: Export) -> Writer:
    assert export.table is not None  # it holds numbers
    return ParquetFile(export.name, export.table)


def _joined(parts: Iterator[bytes], file: BinaryIO) -> None:
    """Write the rows of several files as one, in groups as large as one process makes them."""
    arrow = pyarrow()
    first = arrow.parquet.read_table(io.BytesIO(next(parts)))
    with _writer(arrow, file, first.schema) as writer:
        held, n_held = [first], first.num_rows
        for part in parts:
            table = arrow.parquet.read_table(io.BytesIO(part), schema=first.schema)
            held.append(table)
            n_held += table.num_rows
            if n_held >= ROWS_A_GROUP:
                whole = arrow.concat_tables(held)
                n = n_held // ROWS_A_GROUP * ROWS_A_GROUP
                writer.write_table(whole.slice(0, n), row_group_size=ROWS_A_GROUP)
                held, n_held = [whole.slice(n)], n_held - n
        if n_held or first.num_rows == 0:
            writer.write_table(arrow.concat_tables(held))


PARQUET = Exporter("Parquet", "numbers", _opened, _check, _joined)
