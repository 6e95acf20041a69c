"""The source step ``recording``: frames from files of devices, recognised by content."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from itertools import islice
from pathlib import Path
from typing import Annotated, Any, Literal, NamedTuple

from annotated_types import Ge, Gt

from tactile_graph.errors import DataError, did_you_mean, one_of
from tactile_graph.files import not_a_path, sha256_of
from tactile_graph.foreign_text import pasted
from tactile_graph.quantities import QuantityName
from tactile_graph.steps import Quantity, Report
from tactile_graph.wires import Frame
from tactile_graph.wires.frame_stack import FrameStack
from tactile_graph_sources.readers.choosing.formats import format_of, format_of_folder, known
from tactile_graph_sources.readers.head import Head
from tactile_graph_sources.readers.reading import Reading
from tactile_graph_sources.readers.recording_format import RecordingFormat
from tactile_graph_sources.readers.sequence.by_number import in_order, out_of_order
from tactile_graph_sources.readers.sequence.garbage import stacks_without_garbage, without_garbage
from tactile_graph_sources.readers.sequence.in_ranges import ranges_of_recordings
from tactile_graph_sources.readers.sequence.labels import labels_of
from tactile_graph_sources.readers.sequence.leaps import stacks_with_leaps_told, with_leaps_told
from tactile_graph_sources.readers.words.names import ColumnsTold
from tactile_graph_sources.readers.words.told import Told, as_typed
from tactile_graph_sources.turned_round import Finite, inverted

MOST_NAMED = 5
OF_FRAMES = ("flat", "stacked")
"""Layouts of tables whose lines are frames or rows of them."""
Length = Annotated[float, Gt(0)]


def recording(
    *,
    path: Path | list[Path],
    rows: Annotated[int, Gt(0)] | None = None,
    columns: Annotated[int, Gt(0)] | None = None,
    pitch_cm: Length | tuple[Length, Length] | None = None,
    origin_cm: tuple[float, float] | None = None,
    quantity: QuantityName | None = None,
    sensor: str = "",
    order: Literal["rows", "columns"] = "rows",
    transpose: bool = False,
    flip: Literal["", "rows", "columns", "both"] = "",
    skip: Annotated[int, Ge(0)] = 0,
    frame_column: str = "",
    time_column: str = "",
    time_unit: Literal["", "s", "ms", "us", "ns", "min", "h", "d"] = "",
    time_format: str = "",
    value_column: str = "",
    cells: str = "",
    first_cell: Literal[0, 1] | None = None,
    invert_from: Finite | None = None,
    pad: str | dict[str, Any] | list[str | dict[str, Any]] | None = None,
    missing: Finite | None = None,
    report: Report,
) -> Iterator[Annotated[Frame, Quantity(of="quantity")]]:
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
        Where neither says it, nor ``pad``, 1 cm is assumed and counted in the report.
    origin_cm : (float, float), optional
        Top left corner of the first cell in pad coordinates; goes before the file's own.
    quantity : str, optional
        What the values mean, where the file cannot tell; ``raw`` takes what it says off them.
    sensor : str
        Only frames of sensors whose name contains this; in an ``.npz`` the name of the array, in a
        table whose columns or lines are those of several sensors the one that is read. Several
        sensors in any other file give a frame each, with the sensor's name as label.
    order : str
        Whether cells that come in a row come row by row or column by column.
    transpose : bool
        Whether rows and columns are exchanged once a frame is read; before ``flip``.
    flip : str
        What is turned round: the order of the ``rows`` (top to bottom), of the ``columns``, both.
    skip : int
        How many frames at the start of each file are left out.
    frame_column, time_column, value_column : str
        Columns of a table, by name or number from 1, where the header does not say it.
    time_unit, time_format : str
        Unit of the times, or how dates and times of day are written, as ``strptime`` takes it.
    cells : str
        The columns of a table that are cells: numbers from 1 (``2-65``, ``2-``), or names with
        wildcards (``v*``).
    first_cell : int, optional
        Whether rows and columns count from 0 or from 1 in a table of one cell a line. Where neither
        this nor the cells tell, 1 is assumed and counted in the report.
    invert_from : float, optional
        A value v becomes ``invert_from - v``, where readings fall under pressure.
    pad : str, mapping or list of these, optional
        Pads or their YAML files. Recordings of as many rows and columns that say no pitch have that
        of the first such pad; those that can be of none of its grid are counted in the report.
    missing : float, optional
        The number, as it stands in the file, of cells that are missing: -1, 65535.
    report : Report
        Takes the format that was recognised, counters, troubles, the number of frames to expect
        and the files' digests.

    Yields
    ------
    Frame
        Numbered on from file to file; times are each file's own.

    Raises
    ------
    DataError
        If a file is missing, of no known format, without a single whole frame, or written anew
        while it is read.
    """
    told = Told.of(
        ColumnsTold(frame_column, time_column, value_column, cells, time_unit, time_format),
        rows=rows,
        columns=columns,
        pitch_cm=pitch_cm,
        origin_cm=origin_cm,
        quantity=quantity,
        sensor=sensor,
        order=order,
        transpose=transpose,
        flip=flip,
        skip=skip,
        first_cell=first_cell,
        pad=pad,
        missing=missing,
    )
    index = n_places = 0
    for one, label in _files(path, report):
        found = opened(one, told, report, label).turned_round(invert_from)
        for frame in found.frames:
            yield frame.numbered(index, n_places)
            index += 1
        n_places += found.n_places()
    report.n_places = n_places


def recording_stacked(
    *,
    path: Path | list[Path],
    frame_column: str,
    time_column: str,
    value_column: str,
    cells: str,
    time_unit: Any,
    time_format: str,
    invert_from: float | None = None,
    report: Report,
    **placed: Any,
) -> Iterator[Frame | FrameStack]:
    """Frames of the same recordings, many in a stack where the file holds them as one array."""
    columns = ColumnsTold(frame_column, time_column, value_column, cells, time_unit, time_format)
    told = Told.of(columns, **placed)
    index = n_places = 0
    for one, label in _files(path, report):
        found = opened(one, told, report, label, in_stacks=not told.skip)
        found = found.turned_round(invert_from)
        for some in found.frames:
            yield some.numbered(index, n_places)
            index += 1 if isinstance(some, Frame) else len(some)
        n_places += found.n_places()
    report.n_places = n_places


recording.stacked = recording_stacked  # type: ignore[attr-defined]
recording.ranges = ranges_of_recordings  # type: ignore[attr-defined]


def _files(path: Path | list[Path], report: Report) -> list[tuple[Path, str]]:
    """Return the files, each with what its frames' labels begin with; a doubtful order is told."""
    paths = [Path(p) for p in path] if isinstance(path, list) else [Path(path)]
    if not paths:
        raise ValueError("path is an empty list; give at least one file")
    for one in paths:
        _check_file(one)
    if (found := out_of_order(paths)) is not None:
        report.trouble(
            str(found[0]),
            f"is read after {found[1].name}, in the order in which the files are given; in the "
            f"order of their numbers they are read as a folder of their own: {found[0].parent}",
        )
    return [*zip(paths, labels_of(paths) if len(paths) > 1 else [""], strict=True)]


class Opened(NamedTuple):
    """A recording that is about to be read: what it was recognised as, and its frames.

    ``why`` says in words how it was recognised, once a frame was asked for; ``n_places`` how many
    frames it holds, those that were left out too, once all were.
    """

    format: str
    why: Callable[[], str]
    frames: Iterator[Any]
    n_places: Callable[[], int]

    def turned_round(self, invert_from: float | None) -> Opened:
        """Return the same with a value v as ``invert_from - v``; as it is where that is None."""
        if invert_from is None:
            return self
        return self._replace(frames=(inverted(some, invert_from) for some in self.frames))


def opened(
    path: Path, told: Told, report: Report, label: str = "", in_stacks: bool = False
) -> Opened:
    """Return one recording, recognised; with ``in_stacks`` frames may come as a `FrameStack`.

    Raises
    ------
    DataError
        If it is missing or of no known format.
    """
    _check_file(path)
    try:
        head, found = _recognised(path, told, report)
    except OSError as error:
        raise DataError(str(path), f"cannot be read: {error.strerror or error}") from error
    if told.first_cell is not None and (head.layout is None or head.layout.kind in OF_FRAMES):
        what = "first_cell: it is no table of one cell a line, whose rows and columns are numbered"
        raise DataError(str(path), f"{what}; leave it out")
    reading = Reading(head, told, report, 0, label)
    reading.in_stacks = in_stacks
    frames = islice(_frames(reading, found), told.skip, None)
    where = str(path)
    whole: Iterator[Any]
    if in_stacks:
        whole = stacks_without_garbage(stacks_with_leaps_told(frames, report, where), report, where)
    else:
        whole = without_garbage(with_leaps_told(frames, report, where), report, where)
    why = "by its first lines"
    return Opened(found.name, lambda: reading.why or why, whole, lambda: reading.place)


def _recognised(path: Path, told: Told, report: Report) -> tuple[Head, RecordingFormat]:
    """Return the start of a file, or a folder, and its format; a file's digest is noted."""
    if path.is_dir():
        found = format_of_folder(path, told)
        if found is None:
            raise _no_recording(path)
        return Head(path, b"", told), found
    head = Head.of(path, told)
    report.digest(str(path), sha256_of(path))
    return head, format_of(head)


def _check_file(path: Path) -> None:
    if path.is_file():
        return
    if path.is_dir():
        if format_of_folder(path, Told()) is None:
            raise _no_recording(path)
        return
    if path.exists():
        raise DataError(str(path), "is no plain file; save what it gives as a file first")
    if path.is_symlink():
        raise DataError(str(path), f"is a link to {os.readlink(path)}, which is not there")
    if str(path) == "-":
        raise DataError("-", "is no file; save what standard input gives as a file first")
    siblings = [p.name for p in path.parent.iterdir()] if path.parent.is_dir() else []
    hint = not_a_path(str(path)) or did_you_mean(path.name, siblings)
    raise DataError(str(path), f"there is no such file{hint}")


def _no_recording(folder: Path) -> DataError:
    held = in_order(p.name for p in folder.iterdir() if p.is_file())
    if not held:
        return DataError(str(folder), "is a directory without a file in it; give a file")
    some = ", ".join(held[:MOST_NAMED]) + (", …" if len(held) > MOST_NAMED else "")
    told = f"is a directory; give a file in it ({some})"
    several = f", or all of them: {pasted(str(folder))}/*" if len(held) > 1 else ""
    if held != sorted(held):
        several = (
            ", or several in the order in which they are to be read (a shell's * puts 10 before 2)"
        )
    return DataError(str(folder), told + several)


def _frames(reading: Reading, of: RecordingFormat) -> Iterator[Frame]:
    """Yield the frames of one file; a file without any is an error."""
    path, told, report = reading.path, reading.told, reading.report
    report.count(f"recordings read as {of.name}")
    n_frames = 0
    try:
        for frame in of.read(reading):
            n_frames += 1
            yield frame
    except DataError as error:
        reading.check_unchanged()  # or that is why
        error.what += as_typed(error.what, getattr(error, "sensors", ()))
        raise
    except OSError as error:  # of a folder, a file in it
        where = str(error.filename or path)
        raise DataError(where, f"cannot be read: {error.strerror or error}") from error
    reading.check_unchanged()
    if n_frames:
        if of.laid is None and reading.steady.told:  # frames in any order see but some of them
            reading.assume(reading.steady.told)
        return
    if told.sensor and reading.sensors:
        near = did_you_mean(told.sensor, reading.sensors)
        raise DataError(
            str(path), f"no sensor {told.sensor!r}, there are: {one_of(reading.sensors)}{near}"
        )
    why = f" ({reading.first_damage})" if reading.first_damage else ""
    raise DataError(
        str(path),
        f"it looks like {of.name} but holds no whole frame{why}; formats that are read: {known()}",
    )
