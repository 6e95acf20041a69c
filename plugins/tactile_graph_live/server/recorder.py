"""Frames into a Zarr store, written by a thread of its own."""

from __future__ import annotations

import re
import threading
from collections.abc import Callable, Sequence
from dataclasses import replace
from datetime import datetime
from pathlib import Path
from queue import SimpleQueue

from tactile_graph import Frame
from tactile_graph_live.server.messages import Recording

LONGEST_LABEL = 100
MOST_BYTES = 64 * 2**20
"""Of readings that wait for the disc; of more the newest go, and are counted."""


class Recorder:
    """Writes frames to a new store in a folder, until it is closed.

    Parameters
    ----------
    folder : Path
    name : str
        Of the pipeline; part of the store's name.
    label : str
        Kept with each frame from now on.
    about : dict
        Kept with the store.
    failed : callable
        Called with what went wrong, in the writer's thread.

    Raises
    ------
    UsageError
        If stores cannot be written here.
    """

    def __init__(
        self,
        folder: Path,
        name: str,
        label: str,
        about: dict[str, str],
        failed: Callable[[str], None],
    ) -> None:
        from tactile_graph_sources.writers.write_store import StoreWriter

        self.path = free_name(folder, name, datetime.now())
        self.label = label
        self.n_lost = 0
        self.n_breaks = 0
        self._store = StoreWriter(self.path, about=about)
        self._failed = failed
        self._queue: SimpleQueue[Sequence[Frame] | None] = SimpleQueue()
        self._bytes_taken = self._bytes_done = 0
        self._after_loss = False
        self._thread = threading.Thread(target=self._write, name="tactile-graph recorder")
        self._thread.start()

    @property
    def state(self) -> Recording:
        """What the page says of it."""
        return Recording(True, self.path.name, self._store.n_frames, self.label, self.n_lost)

    def take(self, frames: Sequence[Frame], n_lost: int) -> None:
        """Have frames written under the label of the moment."""
        self.n_lost += n_lost
        self._after_loss = self._after_loss or n_lost > 0
        n_bytes = _bytes_of(frames)
        if self._bytes_taken - self._bytes_done + n_bytes > MOST_BYTES:
            self.n_lost += len(frames)
            self._after_loss = True
            return
        self._bytes_taken += n_bytes
        if self._after_loss and frames:
            frames = [replace(frames[0], gap=True), *frames[1:]]
            self._after_loss = False
        label = self.label
        self._queue.put([_remarked(f, label) for f in frames])

    def broken_off(self) -> None:
        """Note that nobody knows how many frames are lost before the next one."""
        self.n_breaks += 1
        self._after_loss = True

    def close(self) -> int:
        """Write what waits; return how many frames the store holds."""
        self._queue.put(None)
        self._thread.join()
        return self._store.n_written

    def _write(self) -> None:
        try:
            with self._store:
                while (frames := self._queue.get()) is not None:
                    for frame in frames:
                        self._store.write(frame)
                    self._bytes_done += _bytes_of(frames)
        except Exception as error:  # told once, whatever else the end of it came to
            self._failed(str(error) or type(error).__name__)


def _remarked(frame: Frame, label: str) -> Frame:
    """Return a frame under a label of the moment; its own tells whose state steps go on with."""
    if not label and not frame.label:
        return frame
    state_of = frame.label if frame.state_of is None else frame.state_of
    return replace(frame, label=label or frame.label, state_of=state_of)


def _bytes_of(frames: Sequence[Frame]) -> int:
    return sum(f.image.values.nbytes for f in frames)


def free_name(folder: Path, name: str, now: datetime) -> Path:
    """Return a path in the folder where nothing is, named by time and pipeline."""
    plain = re.sub(r"[^A-Za-z0-9_-]+", "-", name).strip("-")[:60] or "pad"
    stem = f"{now:%Y%m%d-%H%M%S}-{plain}"
    path, n = folder / f"{stem}.zarr", 1
    while path.exists() or path.is_symlink():
        n += 1
        path = folder / f"{stem}-{n}.zarr"
    return path
