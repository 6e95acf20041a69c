"""The last minute of frames, as the source gave them, within a bounded number of bytes."""

from __future__ import annotations

import time
from bisect import bisect_right
from collections import deque
from itertools import islice
from threading import Lock

from tactile_graph import Frame

KEPT_S = 60.0
KEPT_BYTES = 64 * 2**20
"""Of readings: half a minute at 1 kHz and 16 x 16 cells."""


class Ring:
    """Keeps frames with the time they came; the oldest go. Two threads may use it.

    Parameters
    ----------
    seconds : float
    n_bytes : int
    """

    def __init__(self, seconds: float = KEPT_S, n_bytes: int = KEPT_BYTES) -> None:
        self._seconds, self._most = seconds, n_bytes
        self._frames: deque[tuple[float, Frame]] = deque()
        self._bytes = 0
        self._lock = Lock()

    def add(self, frame: Frame, now: float | None = None) -> None:
        """Keep a frame that came now (``time.monotonic``)."""
        now = time.monotonic() if now is None else now
        with self._lock:
            self._frames.append((now, frame))
            self._bytes += frame.image.values.nbytes
            while self._bytes > self._most or self._frames[0][0] < now - self._seconds:
                self._bytes -= self._frames.popleft()[1].image.values.nbytes

    def kept(self) -> tuple[float, int]:
        """Return how many seconds and how many frames are kept."""
        with self._lock:
            if not self._frames:
                return 0.0, 0
            return self._frames[-1][0] - self._frames[0][0], len(self._frames)

    def back(self, seconds: float, lead: int = 0) -> tuple[list[Frame], float, bool]:
        """Return the frame that came so long before the newest, those leading up to it before it.

        Returns
        -------
        frames : list of Frame
            Empty if none is kept.
        back_s : float
            How long before the newest it came.
        newer : bool
            Whether a newer one is kept.
        """
        with self._lock:
            times = [t for t, _ in self._frames]
            at = bisect_right(times, times[-1] - max(seconds, 0.0)) - 1 if times else 0
            return self._at(max(at, 0), lead)

    def after(self, index: int, lead: int = 0) -> tuple[list[Frame], float, bool]:
        """Return the first frame kept behind the one of that number; the newest if none is."""
        with self._lock:
            numbers = [f.index for _, f in self._frames]
            at = min(bisect_right(numbers, index), max(len(numbers) - 1, 0))
            return self._at(at, lead)

    def _at(self, at: int, lead: int) -> tuple[list[Frame], float, bool]:
        if not self._frames:
            return [], 0.0, False
        frames = [f for _, f in islice(self._frames, max(0, at - lead), at + 1)]
        back_s = self._frames[-1][0] - self._frames[at][0]
        return frames, back_s, at < len(self._frames) - 1
