"""Framer of replies: what lies between two silences is one unit."""

from __future__ import annotations

import numpy as np

from tactile_graph_sources.devices.counters import LinkCounts
from tactile_graph_sources.devices.layout import Layout
from tactile_graph_sources.devices.units import Units


class ReplyFramer:
    """Takes what lies between two silences as one unit, if it has exactly the right length."""

    def __init__(self, layout: Layout, counts: LinkCounts) -> None:
        self.layout = layout
        self.counts = counts
        self._buffer = bytearray()
        self._length = 0
        self._place = 0
        self._broken = False
        self._ever = False
        self._last_length = 0

    @property
    def complete(self) -> bool:
        """Whether a whole reply is there."""
        return self._length >= self.layout.size

    @property
    def n_whole(self) -> int:
        """How many replies what came since the last silence is enough for."""
        return self._length // self.layout.size

    @property
    def in_part(self) -> bool:
        """Whether that is no whole number of replies."""
        return self._length % self.layout.size > 0

    def feed(self, data: bytes) -> list[Units]:
        """Keep bytes until the next silence; never more than one unit of them."""
        self._length += len(data)
        self._place += len(data)
        room = self.layout.size - len(self._buffer)
        self._buffer += data[:room]
        return []

    def boundary(self) -> list[Units]:
        """Judge what came since the last silence."""
        if self._length == 0:
            return []
        row = np.frombuffer(bytes(self._buffer), np.uint8)[None, :]
        length = self._last_length = self._length
        self._length = 0
        self._buffer.clear()
        size = self.layout.size
        good = length == size and bool(self.layout.ok(row)[0])
        if not good:
            self._refuse(length)
            return []
        self._ever = True
        broken, self._broken = self._broken, False
        return [self.layout.units(row, self._place, broken)]

    def _refuse(self, length: int) -> None:
        self.counts.discarded_bytes += length
        self._broken = True
        size = self.layout.size
        if self._ever:  # before the first frame it is boot text
            cause = "short" if length < size else "long" if length > size else "fixed bytes"
            self.counts.bad[cause] += 1

    def reset(self) -> None:
        """Forget what was buffered."""
        self.counts.discarded_bytes += self._length
        self._buffer.clear()
        self._length, self._broken = 0, True

    def hint(self) -> str:
        """Return what the bytes themselves say about why no frame is found."""
        if self._last_length in (0, self.layout.size):
            return ""
        return f"replies come with {self._last_length} bytes, the preset expects {self.layout.size}"
