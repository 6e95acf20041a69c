"""``Waiting``: the frames that have come and are not answered yet; the oldest go when too many."""

from __future__ import annotations

from collections import deque
from threading import Condition
from typing import NamedTuple

from tactile_graph.wires.frame import Frame


class Arrival(NamedTuple):
    """A frame, and when it came."""

    frame: Frame
    arrived_ns: int


class Waiting:
    """A queue between two threads that holds a bounded number of frames.

    Parameters
    ----------
    capacity : int
        How many frames may wait; at least 1.
    """

    def __init__(self, capacity: int) -> None:
        self._frames: deque[Arrival] = deque(maxlen=capacity)
        self._changed = Condition()
        self._ended = False
        self.n_shed = 0
        """How many frames were shed: each had waited longest when one more came."""

    def put(self, arrival: Arrival) -> None:
        """Add a frame; where there is no room the one that has waited longest goes."""
        with self._changed:
            if len(self._frames) == self._frames.maxlen:
                self.n_shed += 1
            self._frames.append(arrival)
            self._changed.notify()

    def end(self) -> None:
        """Say that no more frames come; those that wait are still taken."""
        with self._changed:
            self._ended = True
            self._changed.notify_all()

    def take(self) -> Arrival | None:
        """Return the frame that has waited longest, or None at the end."""
        with self._changed:
            while not self._frames and not self._ended:
                self._changed.wait()
            return self._frames.popleft() if self._frames else None

    def clear(self) -> None:
        """Let go of all frames that wait, uncounted."""
        with self._changed:
            self._frames.clear()

    @property
    def over(self) -> bool:
        """Whether no frame waits and none will come."""
        return self._ended and not self._frames

    def __len__(self) -> int:
        return len(self._frames)
