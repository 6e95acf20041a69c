"""Write frames to a Zarr store while they come; `store` says what is in it."""

from __future__ import annotations

import json
import os
import platform
import shutil
import time
from collections.abc import Mapping
from pathlib import Path
from types import TracebackType
from typing import Any

import numpy as np

from tactile_graph.errors import DataError, UsageError
from tactile_graph.files import said
from tactile_graph.locks import Lock
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


COLUMNS: dict[str, tuple[str, float]] = {
    "values": ("float64", np.nan),
    "time_s": ("float64", np.nan),
    "device_time_s": ("float64", np.nan),
    "gap": ("bool", False),
    "doubtful": ("bool", False),
    "notes_end": ("int64", 0),
    "number": ("int64", -1),
}


class SoleWriter:
    """The right to write to a store, which one process at a time has.

    Two files stand beside the store, hidden: the lock, which stays, and who holds it.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._lock = Lock(path.with_name(f".{path.name}.lock"))
        self._holder = path.with_name(f".{path.name}.writer")

    def take(self) -> None:
        """Take it, or say who has it.

        Raises
        ------
        UsageError
        """
        with said(self.path):
            if not self._lock.take():
                raise UsageError(f"{self.path}: is being written to{self._who()}")
            since = time.strftime("%Y-%m-%d %H:%M:%S")
            name = f"process {os.getpid()} on {platform.node()}, since {since}"
            self._holder.write_text(name, encoding="utf-8")

    def _who(self) -> str:
        try:
            return f" by {self._holder.read_text(encoding='utf-8')[:200]}"
        except OSError:  # it has the lock, and has not written down who it is
            return " by another process"

    def release(self) -> None:
        """Give it back."""
        if self._lock.held:
            self._holder.unlink(missing_ok=True)
            self._lock.release()


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
        If the path is there and ``append`` is false, another process writes to it, or Zarr is not
        installed.
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
        self._sole = SoleWriter(self.path)
        self._sole.take()
        try:
            if self.path.exists():
                self._reopen()
        except BaseException:
            self._sole.release()
            raise

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
        """Write what is held, and let others write to the store."""
        try:
            self.flush()
        finally:
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
        # Made whole beside its name: a store whose making was cut short would never open.
        part = self.path.with_name(f".{self.path.name}.part")
        with said(self.path):
            shutil.rmtree(part, ignore_errors=True)
            self._make(part, attributes, (int(grid["shape"][0]), int(grid["shape"][1])))
            part.rename(self.path)
            self._group = self._zarr.open_group(str(self.path), mode="r+")
        self._grid = grid

    def _make(self, part: Path, attributes: dict[str, Any], grid: tuple[int, int]) -> None:
        group = self._zarr.create_group(str(part), attributes=attributes)
        codecs = self._zarr.codecs
        packed = [codecs.ZstdCodec(), codecs.Crc32cCodec()]
        few = (SMALL_CHUNKS * self.chunk,)
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
            "notes", shape=(0,), chunks=(NOTE_BYTES,), dtype="uint8", fill_value=0,
            compressors=packed,
        )  # fmt: skip

    def _reopen(self) -> None:
        """Go on behind the last whole chunk; the first new frame follows a gap."""
        group = opened(self.path, "r+")
        if "doubtful" not in group:
            raise UsageError(
                f"{self.path} is of version 1 of the format, which is read but not gone on with; "
                "choose another name"
            )
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
            "doubtful": np.array([f.doubtful for f in frames]),
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
