"""The source step ``recording``: frames from files of devices, recognised by content."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Literal

from annotated_types import Gt

from tactile_graph.errors import DataError, did_you_mean, one_of
from tactile_graph.steps import Report
from tactile_graph.wires import Frame
from tactile_graph_sources.readers.formats import known, reader_of
from tactile_graph_sources.readers.head import Head
from tactile_graph_sources.readers.reading import Reading
from tactile_graph_sources.readers.told import Told
from tactile_graph_sources.store import is_store, read_store

Length = Annotated[float, Gt(0)]
QuantityName = Literal["counts", "volt", "siemens", "gram", "kilopascal", "raw", "level", "binary"]


def recording(
    *,
    path: Path | list[Path],
    rows: Annotated[int, Gt(0)] | None = None,
    columns: Annotated[int, Gt(0)] | None = None,
    pitch_cm: Length | tuple[Length, Length] | None = None,
    origin_cm: tuple[float, float] | None = None,
    quantity: QuantityName | None = None,
    sensor: str = "",
    report: Report,
) -> Iterator[Frame]:
    """Frames of one or more recordings, whatever device or program wrote them.

    The format is recognised by content, never by the file's name; units, pitch and missing cells
    are taken from the file. Pressures become kilopascals. Damaged records are left out, counted
    and reported by line; the frame after one is marked as following a gap. Of frames with the
    same number the first whole one is kept.

    Parameters
    ----------
    path : Path or list of Path
        The files, in the order in which their frames come.
    rows, columns : int, optional
        Shape of a frame, where the file cannot tell.
    pitch_cm : float or (float, float), optional
        Distance of neighbouring cells, or of columns and of rows; goes before the file's own.
        Where neither says it, 1 cm is assumed and counted in the report.
    origin_cm : (float, float), optional
        Top left corner of the first cell in pad coordinates; goes before the file's own.
    quantity : str, optional
        What the values mean, where the file cannot tell.
    sensor : str
        Only frames of sensors whose name contains this; in an ``.npz`` the name of the array.
        Several sensors give a frame each, with the sensor's name as label.
    report : Report
        Takes counters, troubles, the number of frames to expect and the files' digests.

    Yields
    ------
    Frame
        Numbered on from file to file; times are each file's own.

    Raises
    ------
    DataError
        If a file is missing, of no known format, or without a single whole frame.
    """
    paths = [Path(p) for p in path] if isinstance(path, list) else [Path(path)]
    if not paths:
        raise ValueError("path is an empty list; give at least one file")
    for one in paths:
        _check_file(one)
    pitch = (pitch_cm, pitch_cm) if isinstance(pitch_cm, int | float) else pitch_cm
    told = Told(rows, columns, pitch, origin_cm, quantity, sensor)
    index = 0
    for one in paths:
        label = one.name if len(paths) > 1 else ""
        frames = (
            _stored(one, report, index)
            if is_store(one)
            else _frames(one, told, report, index, label)
        )
        for frame in frames:
            yield frame
            index = frame.index + 1


def _check_file(path: Path) -> None:
    if path.is_file() or is_store(path):
        return
    if path.is_dir():
        held = one_of((p.name for p in path.iterdir() if p.is_file()), most=5)
        raise DataError(str(path), f"is a directory; give a file in it ({held})")
    if path.exists():
        raise DataError(str(path), "is no plain file; save what it gives as a file first")
    siblings = [p.name for p in path.parent.iterdir()] if path.parent.is_dir() else []
    raise DataError(str(path), f"there is no such file{did_you_mean(path.name, siblings)}")


def _stored(path: Path, report: Report, index: int) -> Iterator[Frame]:
    """Yield the frames of a Zarr store, numbered on from ``index``."""
    for frame in read_store(path, report):
        yield frame.with_index(index)
        index += 1


def _frames(path: Path, told: Told, report: Report, index: int, label: str) -> Iterator[Frame]:
    """Yield the frames of one file; a file without any is an error."""
    try:
        with path.open("rb") as file:
            report.digest(str(path), hashlib.file_digest(file, "sha256").hexdigest())
        head = Head.of(path, told)
        reader = reader_of(head)
        reading = Reading(head, told, report, index, label)
        yield from reader.read(reading)
    except OSError as error:
        raise DataError(str(path), f"cannot be read: {error.strerror or error}") from error
    if reading.index > index:
        return
    if told.sensor and reading.sensors:
        near = did_you_mean(told.sensor, reading.sensors)
        raise DataError(
            str(path), f"no sensor {told.sensor!r}, there are: {one_of(reading.sensors)}{near}"
        )
    why = f" ({reading.first_damage})" if reading.first_damage else ""
    raise DataError(
        str(path),
        f"it looks like {reader.NAME} but holds no whole frame{why}; "
        f"formats that are read: {known()}",
    )
