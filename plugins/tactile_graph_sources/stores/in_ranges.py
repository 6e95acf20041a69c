"""Stores read in place, any range of their frames by any process."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator
from itertools import accumulate
from pathlib import Path
from typing import Any, NamedTuple

from tactile_graph.errors import DataError
from tactile_graph.steps.injected import Report
from tactile_graph.steps.ranges import Irregular, Ranges
from tactile_graph.wires.frame import Frame
from tactile_graph_sources.readers.garbage import NEIGHBOURS, without_garbage
from tactile_graph_sources.readers.head import Head
from tactile_graph_sources.readers.labels import labels_of
from tactile_graph_sources.readers.leaps import RECENT, with_leaps_told
from tactile_graph_sources.readers.reading import Reading
from tactile_graph_sources.readers.stored_frames import as_told
from tactile_graph_sources.readers.told import Told
from tactile_graph_sources.stores.layout import is_store
from tactile_graph_sources.stores.stored import Lost, Stored, open_stored

BEFORE = max(NEIGHBOURS, RECENT) + 2
"""Frames before one that tell whether it is garbage, and whether its time leaps."""
BEHIND = NEIGHBOURS + 1
TOLD = (
    "rows", "columns", "pitch_cm", "origin_cm", "quantity", "order", "transpose", "flip", "skip",
)  # fmt: skip
"""Settings that change frames one by one, or how many are left out in front."""


def ranges_of_stores(path: Path | list[Path], **settings: Any) -> Ranges | None:
    """Return how the frames of stores are read in any order; None if one is no store, or damaged.

    Parameters
    ----------
    path, **settings
        Of the source ``recording``. With one that may leave out frames anywhere, or is about
        files that are no stores, there is no such way either.
    """
    paths = [Path(p) for p in path] if isinstance(path, list) else [Path(path)]
    others = [value for name, value in settings.items() if name not in TOLD]
    if any(others) or not paths or not all(is_store(p) for p in paths):
        return None
    told = Told.of(**{name: value for name, value in settings.items() if name in TOLD})
    labels = labels_of(paths) if len(paths) > 1 else [""]
    stores = [_Laid(open_stored(p), told, name) for p, name in zip(paths, labels, strict=True)]
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
    """A store, what the settings say of it, and what the labels of its frames begin with."""

    stored: Stored
    told: Told
    label: str

    @property
    def n_frames(self) -> int:
        return self.stored.n_frames - self.told.skip

    def frames(self, low: int, high: int) -> list[Frame]:
        """Return frames by number behind those left out; raises Irregular."""
        skip, where = self.told.skip, str(self.stored.path)
        low, high = low + skip, high + skip
        first, last = max(skip, low - BEFORE), high + BEHIND
        report = Report()
        reading = Reading(Head(self.stored.path, b"", self.told), self.told, report, 0, self.label)
        try:
            told = as_told(reading, self._read(first, last))
            whole = list(without_garbage(with_leaps_told(told, report, where), report, where))
        except DataError as why:  # who reads from the start tells it with its frames before
            raise Irregular(str(why)) from why
        if report.counts:
            raise Irregular(f"{where}: {', '.join(report.counts)}")
        if any(f.label != whole[0].label for f in whole):
            raise Irregular(f"{where}: its frames are of several sensors")
        return whole[low - first : high - first]

    def _read(self, first: int, last: int) -> Iterator[Frame]:
        for piece in self.stored.pieces:
            if piece.high <= first or piece.low >= last:
                continue
            try:
                yield from self.stored.frames(piece, first, last)
            except Lost as why:
                raise Irregular(f"{self.stored.path}: {piece.words}: lost: {why}") from why
