"""Stores read in place, any range of their frames by any process."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterator
from functools import partial
from itertools import accumulate
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from tactile_graph.errors import DataError
from tactile_graph.steps.injected import Report
from tactile_graph.steps.ranges import Irregular, Ranges
from tactile_graph.wires.frame import Frame
from tactile_graph.wires.frame_stack import FrameStack
from tactile_graph_sources.readers.garbage import (
    NEIGHBOURS,
    stacks_without_garbage,
    without_garbage,
)
from tactile_graph_sources.readers.head import Head
from tactile_graph_sources.readers.labels import labels_of
from tactile_graph_sources.readers.leaps import RECENT, stacks_with_leaps_told, with_leaps_told
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

    def read(low: int, high: int, in_stacks: bool = False) -> Iterator[Any]:
        while low < high:
            k = bisect_right(ends, low)
            before = ends[k] - stores[k].n_frames
            end = min(high, ends[k])
            for some in stores[k].frames(low - before, end - before, in_stacks):
                if isinstance(some, FrameStack):
                    yield some.numbered(low)
                    low += len(some)
                else:
                    yield some if some.index == low else some.with_index(low)
                    low += 1

    numbers = tuple(s.n_frames for s in stores)
    return Ranges(numbers, read, stores[0].stored.chunk, partial(read, in_stacks=True))


_Watch = Callable[[Iterator[Any], Report, str], Iterator[Any]]


class _Laid(NamedTuple):
    """A store, what the settings say of it, and what the labels of its frames begin with."""

    stored: Stored
    told: Told
    label: str

    @property
    def n_frames(self) -> int:
        return self.stored.n_frames - self.told.skip

    def frames(self, low: int, high: int, in_stacks: bool) -> Iterator[Frame | FrameStack]:
        """Yield frames by number behind those left out; raises Irregular, at the end too."""
        skip, where = self.told.skip, str(self.stored.path)
        low, high = low + skip, high + skip
        first, last = max(skip, low - BEFORE), high + BEHIND
        report = Report()
        reading = Reading(Head(self.stored.path, b"", self.told), self.told, report, 0, self.label)
        reading.in_stacks = in_stacks
        leaps: _Watch = stacks_with_leaps_told if in_stacks else with_leaps_told
        garbage: _Watch = stacks_without_garbage if in_stacks else without_garbage
        try:
            told = as_told(reading, self._read(first, last, in_stacks))
            whole = _regular(garbage(leaps(told, report, where), report, where), report, where)
            yield from _cut(whole, low - first, high - first)
        except DataError as why:  # who reads from the start tells it with its frames before
            raise Irregular(str(why)) from why

    def _read(self, first: int, last: int, in_stacks: bool) -> Iterator[Frame | FrameStack]:
        for piece in self.stored.pieces:
            if piece.high <= first or piece.low >= last:
                continue
            try:
                read = self.stored.given if in_stacks else self.stored.frames
                yield from read(piece, first, last)
            except Lost as why:
                raise Irregular(f"{self.stored.path}: {piece.words}: lost: {why}") from why


def _regular(
    frames: Iterator[Frame | FrameStack], report: Report, where: str
) -> Iterator[Frame | FrameStack]:
    """Yield frames as long as nothing is to be told of them, and all are of one sensor."""
    labels: set[str] = set()
    for some in frames:
        labels.add("" if isinstance(some, FrameStack) else some.label)
        if len(labels) > 1:
            raise Irregular(f"{where}: its frames are of several sensors")
        if report.counts:
            break
        yield some
    if report.counts:
        raise Irregular(f"{where}: {', '.join(report.counts)}")


def _cut(frames: Iterator[Frame | FrameStack], low: int, high: int) -> Iterator[Frame | FrameStack]:
    """Yield frames by their places, whole stacks or parts of them; those behind are looked at."""
    place = 0
    for some in frames:
        n = len(some) if isinstance(some, FrameStack) else 1
        first, last = max(low - place, 0), min(high - place, n)
        if isinstance(some, FrameStack) and 0 < last - first < n:
            yield some.take(np.arange(first, last))
        elif first < last:
            yield some
        place += n
