"""Stores read in place, any range of their frames by any process."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator
from itertools import accumulate
from pathlib import Path
from typing import Any, NamedTuple

from tactile_graph.steps.injected import Report
from tactile_graph.steps.ranges import Irregular, Ranges
from tactile_graph.wires.frame import Frame
from tactile_graph_sources.readers.garbage import NEIGHBOURS, without_garbage
from tactile_graph_sources.stores.layout import is_store
from tactile_graph_sources.stores.stored import Lost, Stored, open_stored

AROUND = NEIGHBOURS + 1
"""Frames before and behind that tell whether one is garbage."""


def ranges_of_stores(path: Path | list[Path], skip: int = 0, **_: Any) -> Ranges | None:
    """Return how the frames of stores are read in any order; None if one is no store, or damaged.

    Parameters
    ----------
    path, skip
        As of the source ``recording``; its other settings are about files that are no stores.
    """
    paths = [Path(p) for p in path] if isinstance(path, list) else [Path(path)]
    if not paths or not all(is_store(p) for p in paths):
        return None
    stores = [_Laid(open_stored(p), skip) for p in paths]
    if any(s.stored.troubles or not s.stored.sure or s.n_frames <= 0 for s in stores):
        return None
    ends = list(accumulate(s.n_frames for s in stores))

    def read(low: int, high: int) -> Iterator[Frame]:
        while low < high:
            k = bisect_right(ends, low)
            before = ends[k] - stores[k].n_frames
            end = min(high, ends[k])
            for place, frame in enumerate(stores[k].frames(low - before, end - before), low):
                yield frame if frame.index == place else frame.with_index(place)
            low = end

    return Ranges(tuple(s.n_frames for s in stores), read, stores[0].stored.chunk)


class _Laid(NamedTuple):
    """A store, and how many frames at its start are left out."""

    stored: Stored
    skip: int

    @property
    def n_frames(self) -> int:
        return self.stored.n_frames - self.skip

    def frames(self, low: int, high: int) -> list[Frame]:
        """Return frames by number behind those left out; raises Irregular."""
        low, high = low + self.skip, high + self.skip
        first, last = max(self.skip, low - AROUND), high + AROUND
        report = Report()
        whole = list(without_garbage(self._read(first, last), report, ""))
        if report.counts:
            raise Irregular(f"{self.stored.path}: some of its frames are garbage")
        if any(f.label != whole[0].label for f in whole):
            raise Irregular(f"{self.stored.path}: its frames are of several sensors")
        return whole[low - first : high - first]

    def _read(self, first: int, last: int) -> Iterator[Frame]:
        for piece in self.stored.pieces:
            if piece.high <= first or piece.low >= last:
                continue
            try:
                yield from self.stored.frames(piece, first, last)
            except Lost as why:
                raise Irregular(f"{self.stored.path}: {piece.words}: lost: {why}") from why
