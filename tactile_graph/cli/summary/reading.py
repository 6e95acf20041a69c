"""Read result files a chunk at a time: Parquet, data sets of it, CSV, JSON lines."""

from __future__ import annotations

import csv
import json
from collections.abc import Collection, Iterator, Mapping
from itertools import islice
from pathlib import Path
from typing import Any, NamedTuple
from urllib.parse import unquote

import numpy as np
from numpy.typing import NDArray

from tactile_graph.cli.output.data_set import KEY, MANIFEST, manifest_of
from tactile_graph.cli.output.parquet import pyarrow, units_in
from tactile_graph.errors import DataError
from tactile_graph.provenance import sidecar
from tactile_graph.text_files import encoding_of, open_text

ROWS_A_CHUNK = 16_384
LEAD = ("frame", "time_s", "label")
Column = NDArray[Any]
"""float64, NaN where there is nothing and infinite where there is no finite number; or object,
texts, None where there is nothing."""


class Chunk(NamedTuple):
    """Some rows of a table.

    Attributes
    ----------
    recording : str
        Which all rows are of; where it is "", their labels tell.
    columns : dict of str to ndarray, shape (rows,)
    units : dict of str to str
        Of columns whose file tells them.
    """

    recording: str
    columns: dict[str, Column]
    units: Mapping[str, str]


class Lines(NamedTuple):
    """Some lines of JSON, an object a frame."""

    recording: str
    rows: list[dict[str, Any]]


def chunks(path: Path) -> Iterator[Chunk | Lines]:
    """Yield the rows of a result file or data set.

    Raises
    ------
    DataError
        If it is none, or is damaged.
    UsageError
        If it needs a library that is not installed.
    """
    if path.is_dir():
        yield from _data_set(path)
        return
    try:
        with path.open("rb") as file:
            start = file.read(4)
        if start == b"PAR1":
            yield from _parquet(path, "")
        elif start.decode(encoding_of(start), "ignore").lstrip().startswith("{"):
            yield from _json_lines(path)
        else:
            yield from _csv(path)
    except OSError as error:
        raise DataError(str(path), f"cannot be read: {error.strerror or error}") from error
    except UnicodeDecodeError as error:
        what = f"is no result file: no UTF-8 or UTF-16 at byte {error.start}"
        raise DataError(str(path), what) from error


def _data_set(folder: Path) -> Iterator[Chunk]:
    manifest = manifest_of(folder)
    if manifest is not None:
        names = {entry["folder"]: name for name, entry in manifest["recordings"].items()}
    else:
        names = {p.name: unquote(p.name.partition("=")[2]) for p in folder.glob(f"{KEY}=*")}
    parts = sorted(p for name in names for p in (folder / name).glob("*.parquet"))
    if not parts:
        what = (
            "holds no recording yet" if manifest else f"is no data set: no {MANIFEST}, no {KEY}=…"
        )
        raise DataError(str(folder), what)
    for part in parts:
        yield from _parquet(part, names[part.parent.name])


def _parquet(path: Path, recording: str) -> Iterator[Chunk]:
    arrow = pyarrow()
    try:
        with arrow.parquet.ParquetFile(path) as file:
            _check_names(path, file.schema_arrow.names)
            units = units_in(file.schema_arrow)
            for batch in file.iter_batches(ROWS_A_CHUNK):
                found = zip(batch.schema.names, batch.columns, strict=True)
                columns = {n: _of_arrow(arrow, c) for n, c in found}
                _check_frames(str(path), columns)
                yield Chunk(recording, columns, units)
    except arrow.ArrowException as error:
        raise DataError(str(path), f"is no whole Parquet file: {error}") from error


def _of_arrow(arrow: Any, column: Any) -> Column:
    kind = column.type
    if arrow.types.is_boolean(kind):
        words = {True: "yes", False: "no", None: None}
        return np.array([words[v] for v in column.to_pylist()], dtype=object)
    if not (arrow.types.is_integer(kind) or arrow.types.is_floating(kind)):
        return np.array([None if v is None else str(v) for v in column.to_pylist()], dtype=object)
    missing = column.is_null().to_numpy(zero_copy_only=False)
    values: Column = column.to_numpy(zero_copy_only=False).astype(np.float64)
    values[np.isnan(values)] = np.inf
    values[missing] = np.nan
    return values


def _csv(path: Path) -> Iterator[Chunk]:
    units = _units_beside(path)
    with open_text(path, newline="") as file:
        reader = csv.reader(file)
        try:
            names = next(reader, [])
            _check_names(path, names)
            texts = {"label", *(("output", "type") if is_long(names) else ())}
            while rows := list(islice(reader, ROWS_A_CHUNK)):
                if any(len(row) != len(names) for row in rows):
                    end = reader.line_num
                    first = next(i for i, row in enumerate(rows) if len(row) != len(names))
                    line = end - len(rows) + first + 1
                    raise DataError(
                        f"{path}:{line}", f"has {len(rows[first])} cells, the header {len(names)}"
                    )
                found = zip(names, zip(*rows, strict=True), strict=True)
                columns = {n: _of_texts(cells, _is_outcome(n) or n in texts) for n, cells in found}
                _check_frames(str(path), columns)
                yield Chunk("", columns, units)
        except csv.Error as error:
            raise DataError(f"{path}:{reader.line_num}", f"is no CSV: {error}") from error


def _is_outcome(name: str) -> bool:
    return name.rpartition(".")[2] == "outcome"


def is_long(names: Collection[str]) -> bool:
    """Return whether a table of these columns has a row a frame and object."""
    return {"output", "item", "outcome"} <= {*names}


def _of_texts(cells: tuple[str, ...], is_text: bool) -> Column:
    if not is_text:
        try:
            values = np.array([cell or "nan" for cell in cells], dtype=np.float64)
        except ValueError:
            pass
        else:
            told = np.array([cell != "" for cell in cells])
            values[np.isnan(values) & told] = np.inf
            return values
    words = {"True": "yes", "False": "no", "": None}
    return np.array([words.get(cell, cell) for cell in cells], dtype=object)


def _units_beside(path: Path) -> dict[str, str]:
    try:
        told = json.loads(sidecar(path).read_text(encoding="utf-8"))["columns"]
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return {}
    return told if isinstance(told, dict) else {}


def _json_lines(path: Path) -> Iterator[Lines]:
    with open_text(path) as file:
        number = 0
        while texts := list(islice(file, ROWS_A_CHUNK)):
            rows = []
            for number, text in enumerate(texts, number + 1):  # noqa: B020 -- it goes on
                try:
                    row = json.loads(text)
                except ValueError as error:
                    raise DataError(f"{path}:{number}", f"is no JSON: {error}") from error
                except RecursionError as error:
                    what = "is no line of a run: nested too deep"
                    raise DataError(f"{path}:{number}", what) from error
                if not isinstance(row, dict) or not isinstance(row.get("outputs"), dict):
                    raise DataError(f"{path}:{number}", "is no line of a run: has no 'outputs'")
                for name in ("frame", "time_s"):
                    if not isinstance(row.get(name), int | float | None):
                        what = f"{name!r} must be a number, got {row[name]!r}"
                        raise DataError(f"{path}:{number}", f"is no line of a run: {what}")
                rows.append(row)
            yield Lines("", rows)


def _check_names(path: Path, names: list[str]) -> None:
    if "frame" not in names or not any(map(_is_outcome, names)):
        raise DataError(
            str(path),
            "is no result of a run: has no columns 'frame' and '….outcome' "
            "(results are written by 'tactile-graph run … -o FILE')",
        )


def _check_frames(path: str, columns: Mapping[str, Column]) -> None:
    """Refuse a table that does not number its frames."""
    if columns["frame"].dtype == object:
        got = next((v for v in columns["frame"] if v is not None), None)
        raise DataError(
            path, f"is no result of a run: column 'frame' must hold numbers, got {got!r}"
        )


def as_float(number: float | None) -> float:
    """Return a number of JSON; NaN for none, infinity for a whole one that is too large."""
    try:
        return np.nan if number is None else float(number)
    except OverflowError:
        return np.inf
