"""Write a table as a Parquet file: columns of types and units, a group of rows at a time."""

from __future__ import annotations

import io
import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

from tactile_graph.api.result import Result
from tactile_graph.cli.output.older import stays, unfinished_by
from tactile_graph.engine.blocks.block import Block
from tactile_graph.engine.tables.columns import Column
from tactile_graph.engine.tables.table import Table, units_of
from tactile_graph.errors import UsageError, without
from tactile_graph.exporter import Export, Exporter, Writer, check_plain
from tactile_graph.files import left_of, said, uninterrupted
from tactile_graph.part_files import part_of, put_in_place, remove

ROWS_A_GROUP = 10_000
LARGEST = 2**63
"""Whole numbers in Parquet are below this, and not below its negative."""
FRAME = "frame"
"""The column of numbers that frames are counted by."""
MISSING = 'Parquet files need pyarrow: pip install "tactile-graph[parquet]"'


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
    except ImportError as error:
        raise UsageError(without("pyarrow", error, MISSING)) from error
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
        self.lies_at = output
        """Where it stands when it is closed."""
        self.stays = ""
        """What is to be said of an older one that stays."""
        self._target = Path(os.path.realpath(output))
        self._part = part_of(self._target)
        self._table = table
        self._cells: dict[str, list[Any]] = {column.key: [] for column in table.columns}
        self._n_rows = 0
        self._writer: Any = None
        self._quantities: set[str] = set()
        self._units: dict[str, str] = {}

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
        self._quantities.add(quantity)
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
            self._correct_units()
            put_in_place(self._part, self._target, self.lies_at)

    def close_early(self) -> None:
        """Write what is left; an older file stays, and this one gets a name beside it."""
        if beside := unfinished_by(self.output):
            self._target, self.lies_at, self.stays = Path(beside), beside, stays(self.output)
        self.close()

    def discard(self) -> None:
        """Leave nothing of it."""
        self.broken = True
        if self._writer is not None:
            self._writer.close()
        remove(self._part)

    def _correct_units(self) -> None:
        """Write the file anew where later frames were in other units than the first."""
        units = units_of(self._table, self._quantities)
        if units == self._units:
            return
        with self._part.open("r+b") as file:
            _tell_anew(self._pyarrow, file, self._schema_of(units))

    def _schema_of(self, units: dict[str, str]) -> Any:
        arrow = self._pyarrow
        return arrow.schema([_field(arrow, c, units.get(c.key, "")) for c in self._table.columns])

    @contextmanager
    def _whole(self) -> Iterator[None]:
        """Leave nothing behind where anything is raised."""
        try:
            with uninterrupted(), said(self.output, left_of(Path(self.output))):
                yield
        except BaseException:
            self.broken = True
            remove(self._part)
            raise

    def _flush(self) -> None:
        arrow = self._pyarrow
        with self._whole():
            if self._writer is None:
                self._units = units_of(self._table, self._quantities)
                self._schema = self._schema_of(self._units)
                self._writer = _writer(arrow, str(self._part), self._schema)
            cells = [self._array(c) for c in self._table.columns]
            self._writer.write_table(arrow.table(cells, schema=self._schema))
        self._cells = {key: [] for key in self._cells}
        self._n_rows = 0

    def _array(self, column: Column) -> Any:
        """Return a column's cells.

        Raises
        ------
        UsageError
            If a whole number is larger than Parquet holds.
        """
        arrow, cells = self._pyarrow, _plain(self._cells[column.key], column.kind)
        try:
            return arrow.array(cells, self._schema.field(column.key).type)
        except (OverflowError, arrow.ArrowInvalid):
            large = [c for c in cells if isinstance(c, int) and not -LARGEST <= c < LARGEST]
            if not large:
                raise
            raise UsageError(
                f"-o {self.output}: column {column.key!r} holds {_short(large[0])}, and whole "
                "numbers in Parquet have 64 bits; .csv and .jsonl take it"
            ) from None


def _short(number: int) -> str:
    return str(number) if abs(number) < 10**40 else f"a number of {number.bit_length()} bits"


def _tell_anew(arrow: Any, file: BinaryIO, schema: Any) -> None:
    """Write a file anew in place, with other units in its fields."""
    file.flush()
    with tempfile.TemporaryFile() as copy:
        with (
            arrow.parquet.ParquetFile(str(file.name)) as before,
            _writer(arrow, copy, schema) as writer,
        ):
            for i in range(before.num_row_groups):
                group = before.read_row_group(i)
                writer.write_table(group.cast(schema), row_group_size=max(group.num_rows, 1))
        copy.seek(0)
        file.seek(0)
        file.truncate()
        shutil.copyfileobj(copy, file)


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
    if not os.path.isfile(file.name):  # stdout: what was written there cannot be corrected
        with tempfile.TemporaryDirectory(prefix="tactile-graph-") as folder:
            own = Path(folder, "joined")
            with own.open("wb") as joined:
                _joined(parts, joined)
            with own.open("rb") as made:
                shutil.copyfileobj(made, file)
        return
    arrow = pyarrow()
    first = arrow.parquet.read_table(io.BytesIO(next(parts)))
    units = units_in(first.schema)
    agreed = dict(units)
    with _writer(arrow, file, first.schema) as writer:
        held, n_held = [first], first.num_rows
        for part in parts:
            table = arrow.parquet.read_table(io.BytesIO(part))
            its = units_in(table.schema)
            agreed = {name: unit for name, unit in agreed.items() if its.get(name) == unit}
            held.append(table.cast(first.schema))
            n_held += table.num_rows
            if n_held >= ROWS_A_GROUP:
                whole = arrow.concat_tables(held)
                n = n_held // ROWS_A_GROUP * ROWS_A_GROUP
                writer.write_table(whole.slice(0, n), row_group_size=ROWS_A_GROUP)
                held, n_held = [whole.slice(n)], n_held - n
        if n_held or first.num_rows == 0:
            writer.write_table(arrow.concat_tables(held))
    if agreed != units:
        _tell_anew(arrow, file, _with_units(arrow, first.schema, agreed))


def units_in(schema: Any) -> dict[str, str]:
    """Return the units that the fields of a Parquet file tell, by column."""
    return {
        field.name: field.metadata[b"unit"].decode()
        for field in schema
        if field.metadata and b"unit" in field.metadata
    }


def _with_units(arrow: Any, schema: Any, units: dict[str, str]) -> Any:
    told = [f.with_metadata({"unit": units[f.name]}) if f.name in units else f.remove_metadata()
            for f in schema]  # fmt: skip
    return arrow.schema(told)


PARQUET = Exporter("Parquet", "numbers", _opened, _check, _joined)
