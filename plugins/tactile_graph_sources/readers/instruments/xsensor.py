"""XSENSOR CSV exports: frames of one or several sensors."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from tactile_graph.errors import DataError
from tactile_graph.wires import Frame
from tactile_graph_sources.readers.head import Head
from tactile_graph_sources.readers.reading import Reading
from tactile_graph_sources.readers.recording_format import RecordingFormat
from tactile_graph_sources.readers.words.dialect import Dialect
from tactile_graph_sources.readers.words.units import length_cm, pressure_unit, taken_as_they_are

_KEYED = re.compile(r'"?[A-Za-z]')
_CLOCK = re.compile(r"(\d{1,2}):(\d{2}):(\d{2}(?:[.,]\d+)?)")
_LENGTH_KEY = re.compile(r"Sensel (Width|Height) \(([^)]*)\)", re.IGNORECASE)
_PRESSURE_KEY = re.compile(r"Peak Pressure \(([^)]*)\)", re.IGNORECASE)
_DAY_S = 86400.0


def recognises(head: Head) -> bool:
    """Return whether the file has XSENSOR's ``FRAME`` and ``SENSELS`` lines."""
    keys = {re.split(r"[,;\t]", line, maxsplit=1)[0].strip('"') for line in head.lines[:5000]}
    return {"FRAME", "SENSELS"} <= keys or {"FRAME", "SENSOR"} <= keys


@dataclass
class _Sensor:
    """One ``SENSOR`` block of a frame."""

    line: int
    name: str
    keys: dict[str, str] = field(default_factory=dict)
    rows: list[tuple[int, str]] = field(default_factory=list)


@dataclass
class _State:
    """Where in the file the reader is."""

    frame: int | None = None
    time_s: float | None = None
    started_s: float | None = None
    units: str = ""
    sensor: _Sensor | None = None
    in_cells: bool = False


def read(reading: Reading) -> Iterator[Frame]:
    """Yield a frame for each sensor of each ``FRAME``, the sensor's name as its label.

    ``GROUP`` blocks repeat cells of the sensor before them and are left out. Times count from
    the first frame of the file.
    """
    reading.refuse_settings()
    reading.report.expect(reading.count_bytes(b"\nSENSOR"))
    separator = _separator(reading.head)
    dialect = Dialect(separator, decimal_comma=separator != ",")
    state = _State()
    for number, line in reading.text():
        if _KEYED.match(line):
            key, _, value = line.partition(separator)
            value = value.strip(separator + ' "')
            key = key.strip().strip('"')
            if key in ("FRAME", "SENSOR", "GROUP"):
                yield from _flush(reading, dialect, state)
            _keyed(reading, state, number, key, value)
        elif state.in_cells and state.sensor is not None and line.strip(separator + " \t"):
            state.sensor.rows.append((number, line))
    yield from _flush(reading, dialect, state)


def _separator(head: Head) -> str:
    for line in head.lines:
        found = re.match(r'"?(?:FRAME|SENSELS|SENSOR)"?([,;\t])', line)
        if found:
            return found[1]
    return ","


def _keyed(reading: Reading, state: _State, number: int, key: str, value: str) -> None:
    """Take a ``key,value`` line in."""
    if key == "FRAME":
        state.frame = int(value) if value.isdecimal() and len(value) < 10 else None
        state.time_s = None
        if state.frame is None:
            what = f"FRAME is followed by {value[:40]!r}, not by a number"
            wanted = [name for name in reading.sensors if reading.wants(name)]
            reading.damaged(number, what, reading.sensors, n_frames=max(len(wanted), 1))
    elif key == "SENSOR":
        state.sensor = _Sensor(number, value) if state.frame is not None else None
    elif key == "Time" and state.sensor is None:
        state.time_s = _time(state, value)
    elif key == "Units":
        state.units = value
    elif key == "SENSELS":
        state.in_cells = True
    elif state.in_cells and state.sensor is not None:
        # Not a row and not a heading: it stands among the cells, so this record is damaged.
        state.sensor.rows.append((number, key))
    elif state.sensor is not None:
        state.sensor.keys[key] = value


def _time(state: _State, text: str) -> float | None:
    clock = _CLOCK.search(text)
    if clock is None:
        return None
    seconds = int(clock[1]) * 3600.0 + int(clock[2]) * 60.0 + float(clock[3].replace(",", "."))
    if state.started_s is None:
        state.started_s = seconds
    elapsed = seconds - state.started_s
    return elapsed if elapsed >= 0.0 else elapsed + _DAY_S  # the recording went past midnight


def _flush(reading: Reading, dialect: Dialect, state: _State) -> Iterator[Frame]:
    """Yield the frame of the sensor block that ends here, if it is whole and wanted."""
    sensor, state.sensor, was_in_cells = state.sensor, None, state.in_cells
    state.in_cells = False
    if sensor is None or not reading.wants(sensor.name):
        return
    name = f"frame {state.frame} of sensor {sensor.name!r}"
    if not was_in_cells:
        reading.damaged(sensor.line, f"{name} has no SENSELS", [sensor.name])
        return
    try:
        values = _values(reading, dialect, sensor)
    except ValueError as error:
        reading.damaged(sensor.line, f"{name}: {error}", [sensor.name])
        return
    if reading.is_repeat(sensor.line, state.frame or 0, name, sensor.name):
        return
    unit = state.units or _peak_unit(sensor)
    quantity, factor = pressure_unit(unit)
    for note in taken_as_they_are(unit):
        reading.assume(note)
    yield reading.frame(
        values,
        pitch_cm=_pitch(sensor),
        quantity=quantity,
        factor=factor,
        time_s=state.time_s,
        sensor=sensor.name,
        own_number=state.frame,
    )


def _values(reading: Reading, dialect: Dialect, sensor: _Sensor) -> np.ndarray[tuple[int, int]]:
    """Return the cells of a block.

    Raises
    ------
    ValueError
        If Rows and Columns are missing or the cells do not come in that shape.
    """
    said = sensor.keys.get("Rows", ""), sensor.keys.get("Columns", "")
    if not (said[0].isdecimal() and said[1].isdecimal()):
        raise ValueError(f"Rows and Columns are {said[0]!r} and {said[1]!r}, not numbers")
    rows, columns = int(said[0][:9]), int(said[1][:9])
    try:
        reading.told.agree(sensor.name, rows, columns)
    except DataError as error:
        raise ValueError(error.what) from error
    if len(sensor.rows) != rows:
        raise ValueError(f"{len(sensor.rows)} rows, not {rows}")
    values = np.empty((rows, columns))
    for k, (number, line) in enumerate(sensor.rows):
        try:
            values[k] = dialect.row(line, columns)
        except ValueError as error:
            raise ValueError(f"line {number}: {error}") from error
    return values


def _pitch(sensor: _Sensor) -> tuple[float, float] | None:
    sides = {}
    for key, value in sensor.keys.items():
        side = _LENGTH_KEY.fullmatch(key)
        if side:
            sides[side[1].lower()] = length_cm(value, side[2])
    x, y = sides.get("width"), sides.get("height")
    return (x, y) if x and y else None


def _peak_unit(sensor: _Sensor) -> str:
    found = (_PRESSURE_KEY.fullmatch(key) for key in sensor.keys)
    return next((f[1] for f in found if f), "raw")


FORMAT = RecordingFormat("XSENSOR .csv", recognises, read)
