"""Framer of bytes up to an end byte, plain or with runs of zeros written as ``00 n``."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tactile_graph_sources.devices.counters import LinkCounts
from tactile_graph_sources.devices.preset import Delimited, Preset
from tactile_graph_sources.devices.units import Units


class DelimitedFramer:
    """Cuts at the end byte and spreads runs of zeros; all pieces of a feed at once."""

    def __init__(self, preset: Preset, counts: LinkCounts) -> None:
        assert isinstance(preset.framer, Delimited)
        self.counts = counts
        self.end = preset.framer.end
        self.runs = preset.framer.coding == "zero_runs"
        self.n_cells = preset.geometry.n_cells
        self._buffer = b""
        self._place = 0
        self._skipping = True  # until the first end byte nobody knows where a frame starts
        self._ever = False
        self._broken = False
        self._lost = False
        self._last_length = 0

    def feed(self, data: bytes) -> list[Units]:
        """Take bytes, return the runs of good frames that they complete."""
        self._buffer += data
        stop = self._buffer.rfind(self.end) + 1
        if stop == 0:
            self._bound()
            return []
        whole, self._buffer = self._buffer[:stop], self._buffer[stop:]
        start = 0
        if self._skipping:
            start = whole.find(self.end) + 1
            self.counts.discarded_bytes += start
            if self._lost:
                self._refuse("long", 1)
                self._broken = True
            self._skipping = self._lost = False
        out = self._pieces(np.frombuffer(whole, np.uint8)[start:], self._place + start)
        self._place += stop
        self._bound()
        return out

    def _bound(self) -> None:
        """Keep no more than a frame can take: an end byte that never comes fills no memory."""
        if len(self._buffer) > 2 * self.n_cells:
            self.counts.discarded_bytes += len(self._buffer)
            self._place += len(self._buffer)
            self._buffer = b""
            self._lost = self._lost or not self._skipping
            self._skipping = True

    def _pieces(self, array: NDArray[np.uint8], place: int) -> list[Units]:
        if len(array) == 0:
            return []
        ends = np.flatnonzero(array == self.end[0])
        counts, values, damaged = self._spread(array)
        total = np.cumsum(counts)
        length = np.diff(total[ends], prepend=0)
        hurt = np.diff(np.cumsum(damaged)[ends], prepend=0) > 0
        good = (length == self.n_cells) & ~hurt
        if not good.all():
            self._count_bad(length, hurt, good, np.diff(ends, prepend=-1))
        firsts = total[ends] - length
        return self._runs(np.repeat(values, counts), firsts, good, place + ends + 1)

    def _spread(
        self, array: NDArray[np.uint8]
    ) -> tuple[NDArray[np.int64], NDArray[np.uint8], NDArray[np.bool_]]:
        """Return for each byte how many cells it stands for, their value, and if it is wrong."""
        is_end = array == self.end[0]
        if not self.runs:
            return (~is_end).astype(np.int64), array, np.zeros(len(array), np.bool_)
        zero = array == 0
        follows = np.concatenate([[False], zero[:-1]])
        counts = np.where(zero, 0, np.where(is_end, 0, 1)).astype(np.int64)
        counts[follows & ~is_end] = array[follows & ~is_end]
        return counts, np.where(follows, 0, array).astype(np.uint8), follows & (zero | is_end)

    def _count_bad(
        self,
        length: NDArray[np.int64],
        hurt: NDArray[np.bool_],
        good: NDArray[np.bool_],
        n_bytes: NDArray[np.int64],
    ) -> None:
        for cause, which in (
            ("zero run", hurt),
            ("short", ~hurt & (length < self.n_cells)),
            ("long", ~hurt & (length > self.n_cells)),
        ):
            self._refuse(cause, int(np.count_nonzero(which)))
        self.counts.discarded_bytes += int(n_bytes[~good].sum())
        self._last_length = int(length[~good][-1])

    def _refuse(self, cause: str, n: int) -> None:
        if n:
            self.counts.bad[cause] += n

    def _runs(
        self,
        flat: NDArray[np.uint8],
        firsts: NDArray[np.int64],
        good: NDArray[np.bool_],
        ends: NDArray[np.int64],
    ) -> list[Units]:
        """Return the good frames, cut where a bad one lies between them."""
        places = np.flatnonzero(good)
        if len(places) == 0:
            self._broken = True
            return []
        cells = flat[firsts[places][:, None] + np.arange(self.n_cells)]
        cuts = np.flatnonzero(np.diff(places) > 1) + 1
        parts = np.split(np.arange(len(places)), cuts)
        first_broken = self._broken or bool(places[0] > 0)
        out = [
            Units(cells[part], ends[places[part]], first_broken if i == 0 else True)
            for i, part in enumerate(parts)
        ]
        self.counts.resyncs += sum(u.broken for u in out) if self._ever else len(out) - 1
        self._ever = True
        self._broken = bool(places[-1] < len(good) - 1)
        return out

    def boundary(self) -> list[Units]:
        """Nothing to do: frames are found by their end byte."""
        return []

    def reset(self) -> None:
        """Forget what was buffered."""
        self.counts.discarded_bytes += len(self._buffer)
        self._place += len(self._buffer)
        self._buffer, self._skipping, self._lost, self._broken = b"", True, False, True

    def hint(self) -> str:
        """Return what the bytes themselves say about why no frame is found."""
        if self._last_length:
            return f"frames come with {self._last_length} cells, the preset expects {self.n_cells}"
        return f"the end byte {self.end.hex().upper()} was not seen" if self._skipping else ""
