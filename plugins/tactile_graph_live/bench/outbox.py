"""What waits to go through the pipe: sent by a thread of its own, so that nothing waits for it."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from threading import Condition, Thread
from typing import Any

from tactile_graph import Frame
from tactile_graph_live.bench.wire import FromBench, Row, Rows, Snapshot, Taken

MOST_ROWS = 4096
MOST_FRAMES = 8192
AT_ONCE = 256


class Outbox:
    """Sends what it is given in order of urgency; bounded, whatever the other side does.

    The newest picture wins. Of rows and of frames to record the oldest go when too many wait, and
    are counted; these three go in turn, so that none waits for ever where results never end.
    Everything else is small and rare, and goes first.

    Parameters
    ----------
    send : callable
        Sends one thing, and may block.
    """

    def __init__(self, send: Callable[[Any], None]) -> None:
        self._send = send
        self._changed = Condition()
        self._notes: deque[FromBench] = deque(maxlen=1000)
        self._snapshot: Snapshot | None = None
        self._rows: deque[Row] = deque()
        self._frames: deque[Frame] = deque()
        self._lost_rows = self._lost_frames = 0
        self._last_frames = self._ended = False
        self._turns: deque[Callable[[], FromBench | None]] = deque(
            (self._some_rows, self._picture, self._some_frames)
        )
        self._thread = Thread(target=self._go, name="tactile-graph outbox", daemon=True)
        self._thread.start()

    def note(self, note: FromBench) -> None:
        """Have something sent."""
        with self._changed:
            self._notes.append(note)
            self._changed.notify()

    def show(self, snapshot: Snapshot) -> None:
        """Have a picture sent, unless a newer one comes first."""
        with self._changed:
            self._snapshot = snapshot
            self._changed.notify()

    def row(self, row: Row) -> None:
        """Have a result sent."""
        with self._changed:
            if len(self._rows) == MOST_ROWS:
                self._rows.popleft()
                self._lost_rows += 1
            self._rows.append(row)
            self._changed.notify()

    def frame(self, frame: Frame) -> None:
        """Have a frame sent, to be recorded."""
        with self._changed:
            if len(self._frames) == MOST_FRAMES:
                self._frames.popleft()
                self._lost_frames += 1
            self._frames.append(frame)
            if len(self._frames) >= AT_ONCE:
                self._changed.notify()

    def last_frame(self) -> None:
        """Say, behind those that wait, that no more frames are recorded."""
        with self._changed:
            self._last_frames = True
            self._changed.notify()

    def end(self, timeout_s: float = 2.0) -> None:
        """Send what waits, and no more."""
        with self._changed:
            self._ended = True
            self._changed.notify()
        self._thread.join(timeout_s)

    def _next(self) -> FromBench | None:
        with self._changed:
            while True:
                found = self._waiting()
                if found is not None or self._ended:
                    return found
                self._changed.wait(0.25)

    def _waiting(self) -> FromBench | None:
        if self._notes:
            return self._notes.popleft()
        for _ in range(len(self._turns)):
            found = self._turns[0]()
            self._turns.rotate(-1)
            if found is not None:
                return found
        return None

    def _some_rows(self) -> Rows | None:
        if not self._rows:
            return None
        rows, lost = tuple(self._rows), self._lost_rows
        self._rows.clear()
        self._lost_rows = 0
        return Rows(rows, lost)

    def _picture(self) -> Snapshot | None:
        snapshot, self._snapshot = self._snapshot, None
        return snapshot

    def _some_frames(self) -> Taken | None:
        if not (self._frames or self._last_frames):
            return None
        n = min(len(self._frames), AT_ONCE)
        frames, lost = tuple(self._frames.popleft() for _ in range(n)), self._lost_frames
        last = self._last_frames and not self._frames
        self._lost_frames, self._last_frames = 0, self._last_frames and not last
        return Taken(frames, lost, last)

    def _go(self) -> None:
        while (found := self._next()) is not None:
            try:
                self._send(found)
            except (OSError, ValueError):  # the server is gone; the bench ends by its own reader
                return
