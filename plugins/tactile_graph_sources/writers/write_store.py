"""Write frames to a Zarr store while they come; `store` says what is in it."""

from __future__ import annotations

import json
import time
from collections.abc import Mapping
from pathlib import Path
from types import TracebackType
from typing import Any

import numpy as np

from tactile_graph.errors import DataError, UsageError
from tactile_graph.files import said
from tactile_graph.wires.frame import Frame
from tactile_graph.wires.image import Image
from tactile_graph_sources.readers.truth import truth_to_json
from tactile_graph_sources.store import FORMAT, ROWS, VERSION, load_zarr, n_whole, opened

CHUNK = 256
SMALL_CHUNKS = 16
"""Chunks of frames that share one chunk of the small arrays, or there would be too many files."""
NOTE_BYTES = 1 << 16


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

    Raises
    ------
    UsageError
        If the path is there and ``append`` is false, or Zarr is not installed.
    """

    def __init__(
        self,
        path: str | Path,
        chunk: int = CHUNK,
        append: bool = False,
        about: Mapping[str, Any] | None = None,
    ) -> None:
        self.path = Path(path)
        self.chunk = chunk
        self.about = dict(about or {})
        self.n_written = 0
        self._zarr = load_zarr()
        self._group: Any = None
        self._grid: dict[str, Any] = {}
        self._held: list[Frame] = []
        self._marks_gap = False
        self._notes_end = 0
        if self.path.exists() and not append:
            raise UsageError(f"{self.path} is there already; append to it, or choose another name")
        if self.path.exists():
            self._reopen()

    def __enter__(self) -> StoreWriter:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.flush()

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
        if self._group is None:
            self._create(grid)
        if grid != self._grid:
            raise DataError(str(self.path), f"holds {_said(self._grid)}; this one is {_said(grid)}")
        self._held.append(frame)
        if len(self._held) >= self.chunk - self.n_written % self.chunk:
            self.flush()

    def _create(self, grid: dict[str, Any]) -> None:
        attributes = {
            "format": FORMAT,
            "version": VERSION,
            "started": time.strftime("%Y-%m-%dT%H:%M:%S%z"),
            **grid,
            **self.about,
        }
        with said(self.path):
            group = self._zarr.create_group(str(self.path), attributes=attributes)
        rows, columns = grid["shape"]
        shape = {"values": (0, rows, columns)}
        small = (SMALL_CHUNKS * self.chunk,)
        chunks = {"values": (self.chunk, rows, columns)}
        for name, dtype, fill in (
            ("values", "float64", np.nan),
            ("time_s", "float64", np.nan),
            ("device_time_s", "float64", np.nan),
            ("gap", "bool", False),
            ("notes_end", "int64", 0),
            ("number", "int64", -1),
        ):
            group.create_array(
                name,
                shape=shape.get(name, (0,)),
                chunks=chunks.get(name, small),
                dtype=dtype,
                fill_value=fill,
            )
        group.create_array("notes", shape=(0,), chunks=(NOTE_BYTES,), dtype="uint8", fill_value=0)
        self._group, self._grid = group, grid

    def _reopen(self) -> None:
        """Go on behind the last whole chunk; the first new frame follows a gap."""
        group = opened(self.path, "r+")
        self._group = group
        self._grid = {k: group.attrs[k] for k in ("shape", "pitch_cm", "origin_cm", "quantity")}
        self.chunk = int(group["values"].chunks[0])
        self.n_written = n_whole(group)
        ends = group["notes_end"][: self.n_written]
        self._notes_end = int(ends[-1]) if len(ends) else 0
        self._marks_gap = self.n_written > 0
        for name in ROWS:
            array = group[name]
            array.resize((self.n_written, *array.shape[1:]))
        group["notes"].resize((self._notes_end,))

    def flush(self) -> None:
        """Write what is held; the rows count from the moment ``number`` is written.

        Raises
        ------
        UsageError
            If they cannot be written: the disc is full.
        """
        if self._held:
            with said(self.path):
                self._put(self._held)

    def _put(self, frames: list[Frame]) -> None:
        low, high = self.n_written, self.n_written + len(frames)
        notes = [_note(f) for f in frames]
        ends = self._notes_end + np.cumsum([len(n) for n in notes])
        gaps = np.array([f.gap for f in frames])
        gaps[0] |= self._marks_gap
        self._write("notes", self._notes_end, np.frombuffer(b"".join(notes), np.uint8))
        columns: dict[str, Any] = {
            "values": np.stack([f.image.filled(np.nan) for f in frames]),
            "time_s": _seconds([f.time_s for f in frames]),
            "device_time_s": _seconds([f.device_time_s for f in frames]),
            "gap": gaps,
            "notes_end": ends,
            "number": np.arange(low, high),
        }
        for name in ROWS:
            self._write(name, low, columns[name])
        # Only now: a flush cut short by Ctrl-C is done again, over the same rows, at the end.
        self._held, self._marks_gap = [], False
        self.n_written, self._notes_end = high, int(ends[-1])

    def _write(self, name: str, low: int, rows: Any) -> None:
        if len(rows):
            array = self._group[name]
            array.resize((low + len(rows), *array.shape[1:]))
            array[low:] = rows


def _seconds(times: list[float | None]) -> Any:
    return np.array([np.nan if t is None else t for t in times], dtype=np.float64)


def _note(frame: Frame) -> bytes:
    note: dict[str, Any] = {}
    if frame.label:
        note["label"] = frame.label
    if frame.truth is not None:
        note["truth"] = truth_to_json([frame.truth])
    return json.dumps(note).encode() if note else b""
