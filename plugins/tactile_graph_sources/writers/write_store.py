"""Write frames to a Zarr store while they come; `stores.layout` says what is in it."""

from __future__ import annotations

import json
import shutil
import time
from collections.abc import Iterator, Mapping
from functools import partial
from itertools import pairwise
from pathlib import Path
from types import TracebackType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError, UsageError
from tactile_graph.files import put_all_on_disc, put_on_disc, said, uninterrupted, whole_folder
from tactile_graph.foreign_text import pasted
from tactile_graph.wires.frame import Frame
from tactile_graph.wires.image import Image
from tactile_graph_sources.readers.words.own_number import counted
from tactile_graph_sources.readers.words.truth import own_shapes, truth_to_json
from tactile_graph_sources.stores import journal
from tactile_graph_sources.stores.layout import (
    COLUMNS,
    FORMAT,
    JOURNAL,
    MOST_TOGETHER,
    NOTES,
    PITCH_ASSUMED,
    VERSION,
    Metadata,
    array_of,
    chunk_file,
    load_zarr,
    read_metadata,
)
from tactile_graph_sources.stores.repairing import adopt, cut, notes_end, tell_sessions
from tactile_graph_sources.stores.sole_writer import SoleWriter
from tactile_graph_sources.stores.stored import UNSURE, Lost, Session, open_stored
from tactile_graph_sources.writers.recording_writer import OWN_SHAPES, RecordingWriter

CHUNK = 256
SMALL_CHUNKS = 16
"""Chunks of frames that share one chunk of the small arrays, or there would be too many files."""
NOTE_BYTES = 1 << 16
GRID = ("shape", "pitch_cm", "origin_cm", "quantity")


def _grid(image: Image) -> dict[str, Any]:
    return {
        "shape": list(image.shape),
        "pitch_cm": list(image.pitch_cm),
        "origin_cm": list(image.origin_cm),
        "quantity": image.quantity,
    }


def _said(grid: Mapping[str, Any]) -> str:
    rows, columns = grid["shape"]
    x, y = grid["pitch_cm"]
    left, top = grid["origin_cm"]
    return (
        f"{rows} x {columns} cells of {x:g} x {y:g} cm from ({left:g}, {top:g}) cm on, "
        f"{grid['quantity']}"
    )


class StoreWriter:
    """Writes frames to a store, a chunk at a time.

    Parameters
    ----------
    path : path
        The store's directory; made when the first frame comes.
    chunk : int
        Frames in a chunk; a crash loses at most the last one.
    append : bool
        Go on with a store that is there. Otherwise it must not exist.
    about : mapping
        Kept as attributes: preset, pad, port, whatever says where the frames come from.
    called : path, optional
        What errors call it, where it is given another name at the end.

    Raises
    ------
    UsageError
        If the path is there and ``append`` is false, or it is of another pad or preset by what
        ``about`` tells of them (``pad``, ``meaning``), another process writes to it, or Zarr is not
        installed.
    """

    def __init__(
        self,
        path: str | Path,
        chunk: int = CHUNK,
        append: bool = False,
        about: Mapping[str, Any] | None = None,
        called: Path | None = None,
    ) -> None:
        self.path = Path(path)
        self._called = called or self.path
        self.chunk = chunk
        self.about = dict(about or {})
        self.n_written = 0
        self.n_waiting = 0
        """Frames that wait to be taken next: what fills chunks is written in one go with the one
        before, as many take hardly longer than one."""
        self.own_shapes: dict[str, None] = {}
        """Types of plugins' own that true shapes were of; the truth of such frames is left out."""
        self._zarr = load_zarr()
        self._metadata: Mapping[str, Metadata] = {}
        self._attributes: Mapping[str, Any] = {}
        self._grid: dict[str, Any] = {}
        self._held: list[Frame] = []
        self._due = 0
        """How many held frames are written together, where more wait than fill a chunk."""
        self._marks_gap = False
        self._sessions: tuple[Session, ...] = ()
        self._started = ""
        """When the first frame came by which a store is gone on with; until it is written."""
        self._notes_end = 0
        self._is_new = False
        if self.path.exists() and not append:
            raise UsageError(f"{self.path} is there already; append to it, or choose another name")
        self._sole = SoleWriter(self.path, self._called)
        self._sole.take()
        try:
            if self.path.exists():
                self._reopen()
        except BaseException:
            self._sole.release()
            raise
        self.n_before = self.n_written
        """Frames that were in the store already."""

    def __enter__(self) -> StoreWriter:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def close(self) -> None:
        """Write what is held, and let others write to the store; a new one without a frame goes.

        A first Ctrl-C waits meanwhile: what is held would be lost.
        """
        try:
            with uninterrupted(once=True):
                self.flush()
        finally:
            if self._is_new and not self.n_written:
                shutil.rmtree(self.path, ignore_errors=True)
            self._is_new = False  # closed again, another's may be there
            self._sole.release()

    @property
    def n_frames(self) -> int:
        """Frames taken so far, those not yet written included."""
        return self.n_written + len(self._held)

    def write(self, frame: Frame) -> None:
        """Take a frame; it is on disk when its chunk is full, or at `flush`.

        Raises
        ------
        DataError
            If the frame lies on another grid than those before it.
        UsageError
            If a chunk cannot be written.
        """
        grid = _grid(frame.image)
        self.own_shapes |= dict.fromkeys(own_shapes(frame.truth))
        if not self._metadata:
            with uninterrupted():  # a store without the frame it was made for is none
                self._create(grid)
                self._held.append(frame)
        elif grid == self._grid:
            if self.n_frames == self.n_before and not self._is_new:
                self._started = _now()
            self._held.append(frame)
        else:
            told = f"holds {_said(self._grid)}; this one is {_said(grid)}"
            raise DataError(str(self._called), told)
        room = self.chunk - self.n_written % self.chunk
        if len(self._held) == room and self.n_written:
            more = max(0, min(self.n_waiting, MOST_TOGETHER - room))
            self._due = room + more // self.chunk * self.chunk
        if len(self._held) >= max(room, self._due):
            self.flush()

    def _create(self, grid: dict[str, Any]) -> None:
        """Make the store; nothing may interrupt this, as Zarr goes on in threads of its own."""
        attributes = {
            "format": FORMAT,
            "version": VERSION,
            "started": _now(),
            **grid,
            **self.about,
        }
        # Made whole beside its name: a store whose making was cut short would never open.
        part = self.path.with_name(f".{self.path.name}.part")
        with said(self._called):
            shutil.rmtree(part, ignore_errors=True)
            try:
                self._metadata = self._make(part, attributes)
                part.rename(self.path)
                self._is_new = True
                put_on_disc(self.path / JOURNAL, self.path.parent)
            except BaseException:
                shutil.rmtree(part, ignore_errors=True)
                raise
        self._attributes, self._grid = attributes, grid

    def _make(self, part: Path, attributes: dict[str, Any]) -> dict[str, Metadata]:
        """Make an empty store, and return its arrays' metadata by name."""
        group = self._zarr.create_group(str(part), attributes=attributes)
        codecs = self._zarr.codecs
        packed = [codecs.ZstdCodec(), codecs.Crc32cCodec()]
        few = (SMALL_CHUNKS * self.chunk,)
        grid = tuple(attributes["shape"])
        for name, (dtype, fill) in COLUMNS.items():
            wide = name == "values"
            group.create_array(
                name,
                shape=(0, *grid) if wide else (0,),
                chunks=(self.chunk, *grid) if wide else few,
                dtype=dtype,
                fill_value=fill,
                compressors=packed,
            )
        group.create_array(
            NOTES, shape=(0,), chunks=(NOTE_BYTES,), dtype="uint8", fill_value=0,
            compressors=packed,
        )  # fmt: skip
        metadata: dict[str, Metadata] = {n: read_metadata(part, n) or {} for n in (*COLUMNS, NOTES)}
        head = journal.head_line(journal.Head(attributes, metadata))
        (part / JOURNAL).write_bytes(head)
        put_on_disc(part / JOURNAL, part)
        return metadata

    def _reopen(self) -> None:
        """Go on behind the last frame; the first new one follows a gap."""
        stored = open_stored(self.path)
        if not stored.journaled:
            raise UsageError(
                f"{self.path} is of version {stored.attributes['version']} of the format, which is "
                "read but not gone on with; choose another name"
            )
        if stored.troubles:
            raise _damaged(self.path, stored.troubles[0])
        if not stored.sure:
            raise UsageError(
                f"{self.path}: {UNSURE}; it is read but not gone on with, choose another name"
            )
        self._check_about(stored.attributes)
        with said(self.path):
            cut(stored.journal)
            stored = adopt(stored)
        self._metadata = stored.metadata
        self._attributes = stored.attributes
        self._grid = {k: stored.attributes[k] for k in GRID}
        self.chunk = stored.chunk
        self.n_written = stored.n_frames
        self._sessions = stored.sessions
        try:
            self._notes_end = notes_end(stored)
        except Lost as why:
            raise _damaged(self.path, str(why)) from why
        self._marks_gap = self.n_written > 0

    def _check_about(self, kept: Mapping[str, Any]) -> None:
        """Refuse another pad or preset than the store's, as far as both are told."""
        pad, own = self.about.get("pad"), kept.get("pad")
        differ = [f"pad {own!r}, this one is {pad!r}"] if pad and own and pad != own else []
        meaning, own = self.about.get("meaning"), kept.get("meaning")
        if meaning and isinstance(own, Mapping):
            differ += [
                f"preset with {k}: {own.get(k, 'none')}, this one has {meaning.get(k, 'none')}"
                for k in sorted({*own, *meaning})
                if own.get(k) != meaning.get(k)
            ]
        if differ:
            raise UsageError(
                f"{self.path} is of another {'; another '.join(differ)}; choose another name"
            )

    def flush(self) -> None:
        """Write what is held; the rows count from the moment ``number`` is written.

        Raises
        ------
        UsageError
            If they cannot be written: the disc is full, or the store was moved away.
        """
        if self._held:
            self._check_there()
            with said(self._called):
                self._put(self._held)

    def _check_there(self) -> None:
        """Refuse to write where the store is no more: Zarr would make folders of no store there."""
        if not (self.path / JOURNAL).is_file():
            n = len(self._held)
            raise UsageError(
                f"{self._called} is gone: it was moved away or removed while it was written to; "
                f"{n} frame{'s' if n != 1 else ''} after its first {self.n_written} "
                f"{'are' if n != 1 else 'is'} lost"
            )

    def _put(self, frames: list[Frame]) -> None:
        low, high = self.n_written, self.n_written + len(frames)
        values = np.stack([f.image.filled(np.nan) for f in frames])
        columns = self._columns(frames)
        ends = self._notes_end + np.cumsum([len(n) for n in columns.notes])
        rows: dict[str, Any] = {
            "values": values,
            "time_s": columns.time_s,
            "device_time_s": columns.device_time_s,
            "gap": columns.gap,
            "doubtful": columns.doubtful,
            "notes_end": ends,
            "number": np.arange(low, high),
        }
        self._write(NOTES, self._notes_end, np.frombuffer(b"".join(columns.notes), np.uint8))
        for name in COLUMNS:
            self._write(name, low, rows[name])
        edges = [low, *range((low // self.chunk + 1) * self.chunk, high, self.chunk), high]
        parts = [*pairwise(edges)]
        self._put_values_on_disc(edges[:-1])
        journal.append(self.path, b"".join(self._line(low, *p, values, columns) for p in parts))
        # Only now: a flush cut short by Ctrl-C is done again, over the same rows, at the end.
        self._held, self._marks_gap, self._due = [], False, 0
        self.n_written, self._notes_end = high, int(ends[-1])
        if self._started:
            begun, self._started = Session(low, self._started), ""
            tell_sessions(self.path, [*self._sessions, begun])

    def _put_values_on_disc(self, lows: list[int]) -> None:
        """Before the journal vouches for them, which has a copy of all the rest."""
        array = array_of(self.path, "values", self._metadata["values"], lows[-1] + 1)
        chunks = [self.path / chunk_file(array, "values", low) for low in lows]
        # Zarr writes none in which every value is missing.
        put_all_on_disc([c for c in chunks if c.exists()], self.path)

    def _line(
        self, first: int, low: int, high: int, values: NDArray[Any], columns: journal.Columns
    ) -> bytes:
        """Return the journal's line of the frames of one chunk among those from ``first`` on."""
        part = slice(low - first, high - first)
        its: list[Any] = [column[part] for column in columns]
        started = self._started if low == first else ""
        return journal.block_line(
            low, values[part], journal.Columns(*its), self._attributes, started
        )

    def _columns(self, frames: list[Frame]) -> journal.Columns:
        gaps = np.array([f.gap for f in frames])
        gaps[0] |= self._marks_gap
        return journal.Columns(
            _seconds([f.time_s for f in frames]),
            _seconds([f.device_time_s for f in frames]),
            gaps,
            np.array([f.doubtful for f in frames]),
            tuple(_note(f) for f in frames),
        )

    def _write(self, name: str, low: int, rows: Any) -> None:
        if len(rows):
            array = array_of(self.path, name, self._metadata[name], low, "r+")
            array.resize((low + len(rows), *array.shape[1:]))
            array[low:] = rows


def _now() -> str:
    """Return the wall clock's time with its offset from UTC."""
    return time.strftime("%Y-%m-%dT%H:%M:%S%z")


def _damaged(path: Path, what: str) -> UsageError:
    command = f"tactile-graph check --repair {pasted(str(path))}"
    return UsageError(f"{path}: {what}; '{command}' may mend it")


def _seconds(times: list[float | None]) -> Any:
    return np.array([np.nan if t is None else t for t in times], dtype=np.float64)


def _note(frame: Frame) -> bytes:
    note: dict[str, Any] = {}
    if frame.label:
        note["label"] = frame.label
    if frame.state_of is not None:
        note["state_of"] = frame.state_of
    if frame.truth is not None and not own_shapes(frame.truth):
        note["truth"] = truth_to_json([frame.truth])
    if (number := counted(frame.own_number)) is not None:
        note["own_number"] = number
    return json.dumps(note).encode() if note else b""


def _converted(path: Path, frames: Iterator[Frame], about: str, pitch_told: bool = True) -> int:
    """Write a store that gets its name at the end: half of it would pass for the whole."""
    untold = {} if pitch_told else {PITCH_ASSUMED: True}
    with (
        whole_folder(path) as made,
        StoreWriter(made, about={"converted_from": about, **untold}, called=path) as store,
    ):
        for frame in frames:
            store.write(frame)
    if store.n_frames:
        with said(path):
            put_on_disc(path / JOURNAL, path.parent)
    return store.n_frames


WRITER = RecordingWriter(_converted, (OWN_SHAPES,), partial(_converted, pitch_told=False))
