"""Framer of units of fixed size, found by header look-ahead or by checksum."""

from __future__ import annotations

from collections import Counter

import numpy as np
from numpy.typing import NDArray

from tactile_graph_sources.devices.counters import LinkCounts
from tactile_graph_sources.devices.layout import Layout
from tactile_graph_sources.devices.units import Units

RECENT = 8192
"""Bytes kept for a hint while no frame is found."""


class PacketFramer:
    """Finds units in a stream.

    Without a checksum a unit is good when its own fixed bytes are right *and* the next unit's
    follow. The first unit after a loss must also be the only one in its span that looks so:
    between two false headers one frame apart there always stands a true one, so a pad that
    happens to hold the header bytes is never taken for a frame.
    """

    def __init__(self, layout: Layout, counts: LinkCounts) -> None:
        self.layout = layout
        self.counts = counts
        self._buffer = b""
        self._place = 0  # of the buffer's first byte in the stream
        self._locked = False
        self._ever = False
        self._broken = False
        self.recent = b""
        self.near_miss: NDArray[np.uint8] | None = None

    def reset(self) -> None:
        """Forget what was buffered."""
        self.counts.discarded_bytes += len(self._buffer)
        self._place += len(self._buffer)
        self._buffer, self._locked, self._broken = b"", False, True

    def boundary(self) -> list[Units]:
        """Nothing to do: units are found by what they hold."""
        return []

    def feed(self, data: bytes) -> list[Units]:
        """Take bytes, return the runs of good units that they complete."""
        self._buffer += data
        if not self._locked:
            self.recent = (self.recent + data)[-RECENT:]
        out: list[Units] = []
        need = self.layout.size + self.layout.ahead
        at = 0
        array = np.frombuffer(self._buffer, np.uint8)
        while len(array) - at >= need:
            at = self._take(array, at, out) if self._locked else self._search(array, at)
        self._drop(at)
        return out

    def _drop(self, n: int) -> None:
        self._buffer = self._buffer[n:]
        self._place += n

    def _take(self, array: NDArray[np.uint8], at: int, out: list[Units]) -> int:
        """Take the run of good units at ``at``; where it ends too early, unlock."""
        layout = self.layout
        k = (len(array) - at - layout.ahead) // layout.size
        rows = array[at : at + k * layout.size].reshape(k, layout.size)
        fits = layout.ok(rows)
        if layout.ahead:
            good = fits & self._followed(array, at, rows)
        else:
            good = fits & layout.checksum_ok(rows)
        n = k if good.all() else int(np.argmin(good))
        if n:
            end = at + n * layout.size
            out.append(layout.units(rows[:n].copy(), self._place + end, self._broken))
            self._broken = False
            at = end
        if n < k:
            self._lose(rows[n], bool(fits[n]))
            at += 1
            self.counts.discarded_bytes += 1
        return at

    def _followed(
        self, array: NDArray[np.uint8], at: int, rows: NDArray[np.uint8]
    ) -> NDArray[np.bool_]:
        """Return which units have the beginning of another right behind them."""
        ahead, size = self.layout.ahead, self.layout.size
        after = at + len(rows) * size
        last = self.layout.ahead_ok(array[None, after : after + ahead])
        return np.concatenate([self.layout.ahead_ok(rows[1:]), last])

    def _lose(self, row: NDArray[np.uint8], fits: bool) -> None:
        if not fits:
            cause = "header or trailer"
        elif self.layout.crc is not None:
            cause = "checksum"
            self.near_miss = row.copy()
        else:
            cause = "length"
        self.counts.bad[cause] += 1
        self._locked, self._broken = False, True
        self.recent = b""

    def _search(self, array: NDArray[np.uint8], at: int) -> int:
        """Go to the next place that could start a unit; lock if it does."""
        layout = self.layout
        found = self._candidate(array, at)
        self.counts.discarded_bytes += found - at
        if len(array) - found < layout.size + layout.ahead:
            return found
        row = array[None, found : found + layout.size]
        good = bool(layout.ok(row)[0])
        if good and layout.ahead:
            after = found + layout.size
            follows = layout.ahead_ok(array[None, after : after + layout.ahead])
            good = bool(follows[0]) and self._alone(array, found)
        elif good:
            good = bool(layout.checksum_ok(row)[0])
            self.near_miss = None if good else row[0].copy()
        if not good:
            self.counts.discarded_bytes += 1
            return found + 1
        self._locked = True
        self.counts.resyncs += self._ever
        self._ever = True
        if layout.anchor:
            return found
        # Row tags cannot tell the last byte of a frame from a lost first byte of the next one,
        # so the first frame of a lock, whose beginning nothing vouches for, is not taken.
        self._broken = True
        self.counts.discarded_bytes += layout.size
        return found + layout.size

    def _candidate(self, array: NDArray[np.uint8], at: int) -> int:
        """Return the next place from ``at`` on that may start a unit, or where to go on later."""
        layout = self.layout
        if layout.anchor:
            found = self._buffer.find(layout.anchor, at)
            return found if found >= 0 else max(at, len(array) - len(layout.anchor) + 1)
        stop = len(array) - layout.size - layout.ahead + 1
        hits = layout.beginnings(array, at, stop)
        return int(hits[0]) if len(hits) else stop

    def _alone(self, array: NDArray[np.uint8], found: int) -> bool:
        """Return whether no other place inside the unit looks like the beginning of one."""
        layout = self.layout
        end = found + layout.size
        if layout.anchor and layout.ahead == len(layout.anchor):
            return self._buffer.find(layout.anchor, found + 1, end + layout.ahead - 1) < 0
        return len(layout.beginnings(array, found + 1, end)) == 0

    def hint(self) -> str:
        """Return what the bytes themselves say about why no frame is found."""
        layout = self.layout
        if self.near_miss is not None:
            fits = layout.matching_variants(self.near_miss)
            if fits:
                return f"the checksum never fits, but this one would: {fits[0]}"
        if not layout.anchor or len(layout.anchor) < 2:
            return ""
        places = [i for i in range(len(self.recent)) if self.recent.startswith(layout.anchor, i)]
        steps = Counter(np.diff(places).tolist())
        if not steps:
            return f"the header {layout.anchor.hex(' ').upper()} was not seen"
        step, n = steps.most_common(1)[0]
        if n > 1 and step != layout.size:
            return (
                f"headers come every {step} bytes, the preset expects {layout.size}: rows, columns?"
            )
        return ""
