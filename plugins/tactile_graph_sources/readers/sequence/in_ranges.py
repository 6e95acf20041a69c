"""Recordings read in place, any range of their frames by any process."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterator
from functools import partial
from itertools import accumulate
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from tactile_graph.errors import DataError
from tactile_graph.files import sha256_of
from tactile_graph.steps.injected import Report
from tactile_graph.steps.ranges import Irregular, Ranges
from tactile_graph.wires.frame import Frame
from tactile_graph.wires.frame_stack import FrameStack
from tactile_graph_sources.readers.choosing.formats import format_of, format_of_folder
from tactile_graph_sources.readers.head import Head
from tactile_graph_sources.readers.laid import Laid
from tactile_graph_sources.readers.reading import Reading
from tactile_graph_sources.readers.sequence.by_number import out_of_order
from tactile_graph_sources.readers.sequence.garbage import (
    NEIGHBOURS,
    stacks_without_garbage,
    without_garbage,
)
from tactile_graph_sources.readers.sequence.labels import labels_of
from tactile_graph_sources.readers.sequence.leaps import (
    RECENT,
    stacks_with_leaps_told,
    with_leaps_told,
)
from tactile_graph_sources.readers.words.told import Told

BEFORE = max(NEIGHBOURS, RECENT) + 2
"""Frames before one that tell whether it is garbage, and whether its time leaps."""
BEHIND = NEIGHBOURS + 1
TOLD = (
    "rows", "columns", "pitch_cm", "origin_cm", "quantity", "sensor", "order", "transpose", "flip",
    "skip", "pad",
)  # fmt: skip
"""Settings that change frames one by one, or how many are left out in front."""


def ranges_of_recordings(path: Path | list[Path], **settings: Any) -> Ranges | None:
    """Return how the frames of recordings are read in any order; None if one of them cannot be.

    Parameters
    ----------
    path, **settings
        Of the source ``recording``. With one that may leave out frames anywhere, or is about
        tables, there is no such way either.
    """
    paths = [Path(p) for p in path] if isinstance(path, list) else [Path(path)]
    others = [v for name, v in settings.items() if name not in TOLD and v not in (None, "")]
    if others or not paths or out_of_order(paths) is not None:
        return None
    told = Told.of(**{name: value for name, value in settings.items() if name in TOLD})
    labels = labels_of(paths) if len(paths) > 1 else [""]
    if len({*labels}) < len(labels):  # one is given twice: steps go on with the state of its label
        return None
    found = [_opened(p, told, name) for p, name in zip(paths, labels, strict=True)]
    laid = [one for one in found if one is not None and one.n_frames > 0]
    if len(laid) < len(found):
        return None
    ends = list(accumulate(one.n_frames for one in laid))
    places = [0, *accumulate(one.laid.n_frames for one in laid)]

    def read(low: int, high: int, in_stacks: bool = False) -> Iterator[Any]:
        while low < high:
            k = bisect_right(ends, low)
            before = ends[k] - laid[k].n_frames
            end = min(high, ends[k])
            for some in laid[k].frames(low - before, end - before, places[k], in_stacks):
                if isinstance(some, FrameStack):
                    yield some.numbered(low)
                    low += len(some)
                else:
                    yield some if some.index == low else some.with_index(low)
                    low += 1

    def tell(report: Report) -> None:
        for one in laid:
            one.tell(report)

    numbers = tuple(one.n_frames for one in laid)
    return Ranges(numbers, read, laid[0].laid.together, partial(read, in_stacks=True), tell)


def _opened(path: Path, told: Told, label: str) -> _InRanges | None:
    """Return a recording opened; None if its format is not read so, or something is wrong."""
    try:
        if path.is_dir():
            head, found = Head(path, b"", told), format_of_folder(path, told)
        else:
            head = Head.of(path, told)
            found = format_of(head)
        if found is None or found.laid is None:
            return None
        report = Report()
        laid = found.laid(Reading(head, told, report, 0, label))
    except Exception:  # a plugin's format may raise anything: who reads it from the start says so
        return None
    return laid and _InRanges(laid, path, told, label, found.name, report)


_Watch = Callable[[Iterator[Any], Report, str], Iterator[Any]]


class _InRanges(NamedTuple):
    """A recording, what the settings say of it, and what the labels of its frames begin with.

    ``said`` is what there is to say of it as a whole.
    """

    laid: Laid
    path: Path
    told: Told
    label: str
    format: str
    said: Report

    @property
    def n_frames(self) -> int:
        return self.laid.n_frames - self.told.skip

    def tell(self, report: Report) -> None:
        """Tell what reading it from the start tells; raises Irregular where it is damaged."""
        try:
            if self.laid.check is not None:
                self.laid.check()
            if self.path.is_file():
                report.digest(str(self.path), sha256_of(self.path))
        except (DataError, OSError) as why:
            raise Irregular(str(why)) from why
        report.count(f"recordings read as {self.format}")
        report.counts.update(self.said.counts)
        report.assumed.update(self.said.assumed)

    def frames(
        self, low: int, high: int, place: int, in_stacks: bool
    ) -> Iterator[Frame | FrameStack]:
        """Yield frames by number behind those left out; raises Irregular, at the end too.

        ``place`` is that of the file's first frame (`Frame.place`).
        """
        skip, where = self.told.skip, str(self.path)
        low, high = low + skip, high + skip
        first, last = max(skip, low - BEFORE), min(high + BEHIND, self.laid.n_frames)
        report = Report()
        reading = Reading(Head(self.path, b"", self.told), self.told, report, 0, self.label)
        reading.in_stacks, reading.place = in_stacks, place + first
        leaps: _Watch = stacks_with_leaps_told if in_stacks else with_leaps_told
        garbage: _Watch = stacks_without_garbage if in_stacks else without_garbage
        try:
            read = self.laid.frames(reading, first, last)
            whole = _regular(
                garbage(leaps(read, report, where), report, where), report, where, self.said
            )
            yield from _cut(whole, low - first, high - first)
        except DataError as why:  # who reads from the start tells it with its frames before
            raise Irregular(str(why)) from why


def _regular(
    frames: Iterator[Frame | FrameStack], report: Report, where: str, said: Report
) -> Iterator[Frame | FrameStack]:
    """Yield frames as long as there is nothing new to tell of them, and all are of one sensor."""
    labels: set[str] = set()
    for some in frames:
        labels.add("" if isinstance(some, FrameStack) else some.label)
        if len(labels) > 1:
            raise Irregular(f"{where}: its frames are of several sensors")
        if report.counts.keys() - said.counts.keys():
            break
        yield some
    if new := report.counts.keys() - said.counts.keys() - {"troubles"}:
        raise Irregular(f"{where}: {', '.join(sorted(new))}")


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
