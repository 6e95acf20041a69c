"""novel pliance exports (``.asc``)."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError
from tactile_graph.wires import Frame
from tactile_graph_sources.readers.head import Head
from tactile_graph_sources.readers.reading import Reading
from tactile_graph_sources.readers.recording_format import RecordingFormat
from tactile_graph_sources.readers.words.dialect import floats, refuse_underscore
from tactile_graph_sources.readers.words.told import MOST_CELLS
from tactile_graph_sources.readers.words.units import pressure_unit, taken_as_they_are

SUMMARIES = ("MPP", "MVP")
_UNIT = re.compile(r"pressure values in\s+(\S+)", re.IGNORECASE)


def recognises(head: Head) -> bool:
    """Return whether the file has the header of a pliance export."""
    first = [line.strip().lower() for line in head.first(20)]
    return any(line.startswith("electrical:") for line in first) or any(
        line.startswith("pressure values in") for line in first
    )


@dataclass(frozen=True)
class _Mat:
    """Where on the pad each value of a line lies."""

    shape: tuple[int, int]
    places: NDArray[np.intp]
    pitch_cm: tuple[float, float] | None


def read(reading: Reading) -> Iterator[Frame]:
    """Yield a frame for each line ``time value value …`` of the first table.

    Notes
    -----
    The file's own table of corners, at its end, says where each value belongs; its y runs up, so
    row 0 is where its y is largest. The vendor's centres of pressure are in yet another frame,
    turned by 180 degrees against that table: with (x, y) the centre of pressure in our pad
    coordinates (from the top left, y down) and W the mat's width, the vendor prints (W - x, y).
    """
    reading.refuse_settings()
    lines = reading.text()
    quantity, factor, n_values = _header(reading, lines)
    mat = _mat(reading, n_values)
    summed = False
    for number, line in lines:
        fields = line.replace(",", ".").split()
        if not fields:
            continue
        if fields[0] in SUMMARIES:
            reading.report.count("summary rows left out")
            summed = True
            continue
        if summed or fields[0].startswith("time["):
            break
        frame = _frame(reading, number, line, fields, n_values)
        if frame is not None:
            values = np.full(mat.shape[0] * mat.shape[1], np.nan)
            values[mat.places] = frame[1:]
            yield reading.frame(
                values.reshape(mat.shape),
                pitch_cm=mat.pitch_cm,
                quantity=quantity,
                factor=factor,
                time_s=frame[0],
            )


def _header(reading: Reading, lines: Iterator[tuple[int, str]]) -> tuple[str, float, int]:
    unit = "raw"
    for _, line in lines:
        found = _UNIT.search(line)
        unit = found[1] if found else unit
        if line.startswith("time["):
            quantity, factor = pressure_unit(unit)
            for note in taken_as_they_are(unit):
                reading.assume(note)
            return quantity, factor, len(line.split()) - 1
    raise DataError(str(reading.path), "no line of cell numbers (time[secs] 1 2 3 …) in it")


def _frame(
    reading: Reading, number: int, line: str, fields: list[str], n_values: int
) -> list[float] | None:
    """Return time and values of a line; None where it is damaged or comes again."""
    try:
        if len(fields) != n_values + 1:
            raise ValueError(f"{len(fields) - 1} values, not {n_values}")
        refuse_underscore(line)
        frame = floats(fields)
        if not np.isfinite(frame[0]):
            raise ValueError("the time is no number")
    except ValueError as error:
        reading.damaged(number, str(error))
        return None
    return None if reading.is_repeat(number, frame[0], f"time {frame[0]:g} s") else frame


def _mat(reading: Reading, n_values: int) -> _Mat:
    centres = _centres(reading, n_values)
    mat = None if centres is None else _lattice(*centres)
    told = reading.told
    if mat is None:
        if told.rows is None and told.columns is None:
            raise DataError(
                str(reading.path),
                f"no table of corners says how its {n_values} cells lie; give rows and columns",
            )
        shape = told.fits(n_values)
        if shape is None:
            raise DataError(str(reading.path), told.misfit(n_values))
        rows, columns = shape
        # The vendor counts down the columns.
        places = np.arange(n_values).reshape(rows, columns, order="F").argsort(axis=None)
        return _Mat((rows, columns), places, None)
    told.agree(str(reading.path), *mat.shape)
    return mat


def _centres(
    reading: Reading, n_values: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
    """Return x and y of the cells' centres, from the table at the end of the file."""
    found = {}
    for line in reading.lines_from(b"corner[cm]"):
        name, _, rest = line.strip().partition(" ")
        if name in ("x[c]", "y[c]"):
            try:
                found[name] = np.array(floats(rest.replace(",", ".").split()))
            except ValueError as error:
                reading.report.trouble(reading.at("corner[cm]"), f"{name}: {error}")
    x, y = found.get("x[c]"), found.get("y[c]")
    whole = x is not None and y is not None and len(x) == len(y) == n_values > 0
    return (x, y) if x is not None and y is not None and whole else None


def _lattice(x: NDArray[np.float64], y: NDArray[np.float64]) -> _Mat | None:
    """Return the mat on which the cells form rows and columns; None where they form none."""
    column, pitch_x = _steps(x)
    row, pitch_y = _steps(-y)
    if column is None or row is None:
        return None
    rows, columns = int(row.max()) + 1, int(column.max()) + 1
    places = row * columns + column
    if rows * columns > MOST_CELLS or len(np.unique(places)) < len(places):
        return None
    return _Mat((rows, columns), places, (pitch_x or pitch_y, pitch_y or pitch_x))


def _steps(position: NDArray[np.float64]) -> tuple[NDArray[np.intp] | None, float]:
    """Return positions as numbers of equal steps from the least, and the step in cm."""
    if not np.isfinite(position).all() or np.abs(position).max() > 1e6:
        return None, 0.0
    distinct = np.unique(np.round(position, 4))
    if len(distinct) == 1:
        return np.zeros(len(position), dtype=np.intp), 0.0
    step = float(np.diff(distinct).min())
    count = np.round((distinct[-1] - distinct[0]) / step)
    if count > MOST_CELLS:
        return None, 0.0
    step = float(distinct[-1] - distinct[0]) / float(count)
    number = (position - distinct[0]) / step
    whole = np.round(number)
    return (whole.astype(np.intp), step) if np.abs(number - whole).max() < 0.1 else (None, 0.0)


FORMAT = RecordingFormat("novel pliance .asc", recognises, read)
