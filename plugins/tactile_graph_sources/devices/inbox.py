"""``Inbox``: the bounded queue between the reader's thread and whoever takes the frames."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Iterable
from typing import NamedTuple

from tactile_graph_sources.devices.counters import LinkCounts
from tactile_graph_sources.devices.decoder import Decoded


class Arrived(NamedTuple):
    """A decoded frame and the host's time (`time.perf_counter`) at which its last byte came."""

    frame: Decoded
    time_s: float


class Inbox:
    """Holds frames until they are taken.

    Parameters
    ----------
    newest : bool
        True: one frame, a newer one replaces it and the old one is counted as dropped (bounded
        delay, for viewers). False: up to ``size`` frames, and the reader is held back, which is
        counted, when it is full (for recording).
    size : int
    counts : LinkCounts
    """

    def __init__(self, newest: bool, size: int, counts: LinkCounts) -> None:
        self.newest = newest
        self.size = 1 if newest else size
        self.counts = counts
        self._frames: deque[Arrived] = deque()
        self._changed = threading.Condition()
        self._closed = False
        self._failure: BaseException | None = None

    def put(self, arrived: Iterable[Arrived]) -> None:
        """Add frames; blocks while a lossless inbox is full, unless it is closed."""
        with self._changed:
            for item in arrived:
                if len(self._frames) >= self.size:
                    item = self._make_room(item)
                self._frames.append(item)
                self._changed.notify_all()

    def _make_room(self, item: Arrived) -> Arrived:
        if self.newest:
            old = self._frames.popleft()
            self.counts.dropped += 1
            # The mark must outlive the frame that bore it, or a viewer never hears of the gap.
            return Arrived(item.frame._replace(gap=True), item.time_s) if old.frame.gap else item
        self.counts.held_back += 1
        self._changed.wait_for(lambda: self._closed or len(self._frames) < self.size)
        return item

    def __len__(self) -> int:
        """Return how many frames wait to be taken."""
        return len(self._frames)

    def get(self, timeout_s: float) -> Arrived | None:
        """Return the oldest frame, or None if none came in time; raises what broke the reader."""
        with self._changed:
            self._changed.wait_for(
                lambda: bool(self._frames or self._closed or self._failure), timeout_s
            )
            if self._frames:
                item = self._frames.popleft()
                self._changed.notify_all()
                return item
            if self._failure is not None:
                raise self._failure
            return None

    def fail(self, error: BaseException) -> None:
        """Hand an error of the reader to whoever takes the frames."""
        with self._changed:
            self._failure = error
            self._changed.notify_all()

    def close(self) -> None:
        """Let go whoever waits; what the reader has by now may still be put and taken."""
        with self._changed:
            self._closed = True
            self._changed.notify_all()
