"""The last minute of frames, as the source gave them, within a bounded number of bytes."""

from __future__ import annotations

import time
from bisect import bisect_right
from threading import Lock
from typing import NamedTuple

from tactile_graph import Frame

KEPT_S = 60.0
KEPT_BYTES = 64 * 2**20
"""Of readings: half a minute at 1 kHz and 16 x 16 cells."""
ROOM = 1024
"""Places of frames that are gone before the list is cut."""


class Kept(NamedTuple):
    """A frame and when it came."""

    came_s: float
    frame: Frame


class Found(NamedTuple):
    """A frame that is kept, behind those that lead up to it; no frames if none is kept.

    ``back_s`` is how long before the newest it came, ``newer`` whether a newer one is kept.
    """

    frames: list[Frame]
    back_s: float
    newer: bool


class Ring:
    """Keeps frames with the time they came; the oldest go. Two threads may use it.

    Finding one takes no longer the more are kept: the reader's thread must not wait for it.

    Parameters
    ----------
    seconds : float
    n_bytes : int
    """

    def __init__(self, seconds: float = KEPT_S, n_bytes: int = KEPT_BYTES) -> None:
        self._seconds, self._most = seconds, n_bytes
        self._kept: list[Kept | None] = []
        self._first = 0
        self._bytes = 0
        self._lock = Lock()

    def add(self, frame: Frame, now: float | None = None) -> None:
        """Keep a frame that came now (``time.perf_counter``)."""
        now = time.perf_counter() if now is None else now
        with self._lock:
            self._kept.append(Kept(now, frame))
            self._bytes += frame.image.values.nbytes
            while self._first < len(self._kept) - 1 and (
                self._bytes > self._most or self._at(self._first).came_s < now - self._seconds
            ):
                self._bytes -= self._at(self._first).frame.image.values.nbytes
                self._kept[self._first] = None
                self._first += 1
            if self._first > max(ROOM, len(self._kept) // 2):
                del self._kept[: self._first]
                self._first = 0

    def kept(self) -> tuple[float, int]:
        """Return how many seconds and how many frames are kept."""
        with self._lock:
            n = len(self._kept) - self._first
            if not n:
                return 0.0, 0
            return self._at(-1).came_s - self._at(self._first).came_s, n

    def back(self, seconds: float, lead: int = 0) -> Found:
        """Return the frame that came so long before the newest, and ``lead`` before it."""
        with self._lock:
            if len(self._kept) == self._first:
                return Found([], 0.0, False)
            then = self._at(-1).came_s - max(seconds, 0.0)
            at = bisect_right(self._kept, then, lo=self._first, key=_came_s) - 1
            return self._found(max(at, self._first), lead)

    def after(self, index: int, lead: int = 0) -> Found:
        """Return the first frame kept behind the one of that number; the newest if none is."""
        with self._lock:
            if len(self._kept) == self._first:
                return Found([], 0.0, False)
            at = bisect_right(self._kept, index, lo=self._first, key=_index)
            return self._found(min(at, len(self._kept) - 1), lead)

    def _at(self, at: int) -> Kept:
        kept = self._kept[at]
        assert kept is not None
        return kept

    def _found(self, at: int, lead: int) -> Found:
        frames = [self._at(i).frame for i in range(max(self._first, at - lead), at + 1)]
        back_s = self._at(-1).came_s - self._at(at).came_s
        return Found(frames, back_s, at < len(self._kept) - 1)


def _came_s(kept: Kept | None) -> float:
    assert kept is not None
    return kept.came_s


def _index(kept: Kept | None) -> int:
    assert kept is not None
    return kept.frame.index
