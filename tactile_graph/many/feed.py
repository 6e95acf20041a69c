"""A source's frames in portions: by number where workers read them, sent along where not."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing
from itertools import chain, islice
from pathlib import Path
from typing import Any

from tactile_graph.api.pipeline import Pipeline
from tactile_graph.many.division import Division
from tactile_graph.many.portion import Portion
from tactile_graph.many.sent import PortionSize, sent
from tactile_graph.pipeline.graph import Source
from tactile_graph.steps.injected import Report
from tactile_graph.steps.ranges import Irregular, Ranges

MOST_READ = 16_384
"""Frames of a portion that a worker reads itself: so many lines are sent back at once."""
SHORTEST = 8
"""Times that the last portions may be shorter than the others, for all workers to end together."""


def ranges_of(source: Source | None) -> Ranges | None:
    """Return what reads a source's frames in any order; None if nothing does."""
    offered = getattr(source.signature.target, "ranges", None) if source is not None else None
    if source is None or offered is None:
        return None
    found: Ranges | None = offered(**source.signature.arguments(source.settings))
    return found


def absolute(settings: dict[str, Any]) -> dict[str, Any]:
    """Return a source's settings with paths that hold in any folder."""

    def of(value: Any) -> Any:
        if isinstance(value, list):
            return [of(v) for v in value]
        return value.absolute() if isinstance(value, Path) else value

    return {name: of(value) for name, value in settings.items()}


class Feed:
    """The portions of a run.

    Parameters
    ----------
    pipeline : Pipeline
    seed : int
        Of the source, if it takes one.
    report : Report
        Receives what the source has to say.
    span : (int, int or None)
        Which frames, by their place in the source.
    division : Division
    ranges : Ranges, optional
    in_stacks : bool
        Whether frames that are sent go in stacks where the source has them so.
    is_led : bool
        Whether steps that keep state see the frames before ``span``, too.

    Attributes
    ----------
    size : PortionSize
        Of the next portion.
    irregular : str
        Why frames that could be read in place are sent; "" if none is.
    """

    def __init__(
        self,
        pipeline: Pipeline,
        seed: int,
        report: Report,
        span: tuple[int, int | None],
        division: Division,
        ranges: Ranges | None,
        in_stacks: bool = False,
        is_led: bool = False,
    ) -> None:
        self._pipeline, self._seed, self._report = pipeline, seed, report
        self._division, self._ranges = division, ranges
        low, high = span
        self._in_stacks = in_stacks and high is None
        self.start = low
        self._first = 0 if is_led else low
        self._stop = high
        self.size = PortionSize() if ranges is None else PortionSize(MOST_READ)
        self._begun: Iterator[Portion] | None = None
        self._said = Report()
        self._is_ended = False
        self.irregular = ""
        if ranges is not None:
            n = ranges.n_frames
            self._stop = n if high is None else min(high, n)
            report.expect(n)

    @property
    def in_place(self) -> bool:
        """Whether workers read the frames themselves."""
        return self._ranges is not None

    def begin(self, low: int) -> None:
        """Look through recordings that are read in place; read the first portion where frames are
        sent: the source then says how many there are."""
        try:
            self.look_through()
        except Irregular as why:
            self.send(str(why))
        if self._ranges is None:
            portions = self._sent(low)
            first = next(portions, None)
            self._begun = iter(()) if first is None else chain([first], portions)

    def look_through(self) -> None:
        """Look through recordings that are read in place.

        Raises
        ------
        Irregular
            If they cannot be.
        """
        if self._ranges is not None and self._ranges.tell is not None:
            self._ranges.tell(self._said)

    def portions(self, low: int, n_workers: int) -> Iterator[Portion]:
        """Yield the portions from the frame at a place on."""
        if self._ranges is not None:
            return self._read(low, n_workers, self._ranges)
        begun, self._begun = self._begun, None
        return self._sent(low) if begun is None else begun

    def send(self, why: str) -> None:
        """Send frames from now on: they cannot be read in any order."""
        self._ranges, self.irregular = None, why
        self._report.n_expected = None  # the source will say so itself

    def end(self, n_frames: int) -> None:
        """Report, once, what recordings read in place have to say, and how many frames came."""
        if self._ranges is not None and not self._is_ended:
            self._is_ended = True
            self._report.counts.update(self._said.counts)
            self._report.assumed.update(self._said.assumed)
            self._report.counts["frames"] += n_frames
            self._report.digests.update(self._said.digests)

    def _read(self, low: int, n_workers: int, ranges: Ranges) -> Iterator[Portion]:
        stop = ranges.n_frames if self._stop is None else self._stop
        start = 0
        for n in ranges.recordings:
            end = min(start + n, stop)
            whole = self._division.by_recording
            while low < end:
                size = n if whole else self._whole_chunks(low, stop, n_workers, ranges.together)
                high = min(low + size, end)
                yield Portion(low, high, start=low if whole else max(start, self._first))
                low = high
            start += n

    def _whole_chunks(self, low: int, stop: int, n_workers: int, together: int) -> int:
        """Return how long a portion is: of whole chunks, and shorter towards the end."""
        usual = self.size.n_frames
        size = min(usual, max(1, usual // SHORTEST, (stop - low) // (2 * n_workers)))
        if size < together:
            return min(size, together - low % together)
        return (low + size) // together * together - low

    def _sent(self, low: int) -> Iterator[Portion]:
        pipeline = self._pipeline
        in_stacks = self._in_stacks and low == 0  # places count frames
        source = pipeline.frames_in_stacks if in_stacks else pipeline.frames
        with closing(source(self._seed, self._report)) as frames:  # type: ignore[type-var]
            yield from sent(islice(frames, low, self._stop), low, self.size)
