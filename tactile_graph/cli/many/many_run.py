"""``run --workers`` from its first frame, or where an earlier one ended, to its closing lines."""

from __future__ import annotations

import sys
from collections.abc import Generator, Iterator, Mapping
from contextlib import closing
from dataclasses import dataclass, field
from typing import Any

from tactile_graph.api.pipeline import Pipeline
from tactile_graph.cli.arguments import Span
from tactile_graph.cli.endings import SOME_FAILED
from tactile_graph.cli.interrupt import Interrupts, code_of, words_of
from tactile_graph.cli.many.finished import refuse_other, stays
from tactile_graph.cli.many.job import Done, Job, done, for_workers
from tactile_graph.cli.many.made_of import changed, made_of
from tactile_graph.cli.many.piped import piped
from tactile_graph.cli.many.unfinished import Unfinished
from tactile_graph.cli.output.outputs import Output
from tactile_graph.cli.output.progress import Bar
from tactile_graph.cli.output.tally import Tally
from tactile_graph.cli.terminal import console
from tactile_graph.engine.blocks.gathering import is_long
from tactile_graph.engine.tables.columns import columns_of
from tactile_graph.engine.tables.table import (
    make_table,
    units_of,
    without_columns,
    without_one_unit,
)
from tactile_graph.errors import DataError, UsageError
from tactile_graph.files import uninterrupted, whole_file
from tactile_graph.many.division import Division, division_of, led_to
from tactile_graph.many.executor_kind import Place
from tactile_graph.many.feed import Feed, ranges_of
from tactile_graph.many.in_order import InOrder
from tactile_graph.many.portion import Portion, packed
from tactile_graph.many.reading import Reading
from tactile_graph.many.sharing import KILLER
from tactile_graph.provenance import provenance, write_provenance
from tactile_graph.steps.injected import Report
from tactile_graph.steps.ranges import Ranges


class InOneRow(Exception):  # noqa: N818 -- what the frames are
    """Frames whose state hangs on all before them cannot be divided after all, and why."""


@dataclass(frozen=True)
class Asked:
    """What is asked of a run with workers."""

    pipeline: Pipeline
    only: tuple[str, ...]
    span: Span
    seed: int
    output: Output
    verify: bool
    place: Place
    resume: bool

    @property
    def outputs(self) -> tuple[str, ...]:
        """What is asked of the pipeline."""
        return self.only or tuple(self.pipeline.outputs)


def division_for(asked: Asked) -> tuple[Division, Ranges | None]:
    """Return how the frames may be divided, and what reads them in any order."""
    ranges = ranges_of(asked.pipeline.source)
    plan = asked.pipeline.runner(asked.only, asked.seed).plan
    why_not = ""
    if asked.output.exporter.joined is None:
        why_not = f"parts of {asked.output.exporter.called} files cannot be joined"
    division = Division({}, why_not=why_not) if why_not else division_of(plan, ranges)
    return led_to(asked.span.start, division), ranges


def hangs_on(asked: Asked, division: Division) -> dict[str, str]:
    """Return digests of all that the output hangs on; none where no output stays."""
    output, span = asked.output, [asked.span.start, asked.span.stop]
    if not stays(output.name):
        return {}
    options = {
        "asked": asked.outputs, "seed": asked.seed, "span": span, "form": output.ending,
        "full": output.full, "long": output.long, "memory": division.by_recording,
    }  # fmt: skip
    return made_of(asked.pipeline, options)


@dataclass
class ManyRun:
    """One run: portions of frames to workers, what they come to into one file."""

    asked: Asked
    division: Division
    ranges: Ranges | None
    of: Mapping[str, str]
    interrupted: KeyboardInterrupt | None = None
    error: Exception | None = None
    left_out: list[int] = field(default_factory=list)
    quantities: set[str] = field(default_factory=set)
    without_unit: str = ""
    without_columns: str = ""

    def go(self) -> int:
        """Run, say what came of it, and return the exit code.

        Raises
        ------
        InOneRow
            If frames can be read only after those before them, and so does state: nothing of what
            was done is kept.
        """
        asked = self.asked
        self.report = Report()
        span = (asked.span.start, asked.span.stop)
        in_stacks = asked.pipeline.runner(asked.only, asked.seed).in_blocks
        self.feed = Feed(
            asked.pipeline, asked.seed, self.report, span, self.division, self.ranges, in_stacks,
            is_led=True,
        )  # fmt: skip
        self.columns = columns_of(asked.pipeline, asked.outputs)
        self.tally = Tally(self.columns)
        self.people, self.stderr = console(stderr=True), console(stderr=True)
        self.bar = Bar(self.stderr, asked.pipeline.name)
        self.low = asked.span.start
        self.n_kept = 0
        name = asked.output.name
        self.unfinished = Unfinished(name) if Unfinished.possible(name) else None
        self._begin()
        with Interrupts() as interrupts:
            try:
                self._run(interrupts.held)
            finally:
                if self.unfinished is not None:
                    self.unfinished.end(kept=self.low > asked.span.start)
        return self._close()

    # -- what was done before ------------------------------------------------------------------

    def _begin(self) -> None:
        """Begin anew, or find where an earlier run ended."""
        if self.unfinished is None:
            return
        before = self.unfinished.read() if self.asked.resume else None
        if before is None:
            if self.asked.resume:
                refuse_other(self.asked.output, self.of)
            self.unfinished.begin(self.of)
            return
        other = changed(before, self.of)
        if other:
            self.unfinished.close()
            raise UsageError(
                f"--resume: {self.asked.output.name} was begun with other content: {other}; "
                "without --resume it is begun anew"
            )
        if self.unfinished.high is not None and self.unfinished.so_far is not None:
            self._go_on(self.unfinished.high, self.unfinished.so_far)

    def _go_on(self, high: int, so_far: Mapping[str, Any]) -> None:
        self.low = high
        self.tally = Tally.of_kept(self.columns, so_far["tally"])
        self.quantities = {*so_far["quantities"]}
        self.n_kept = self.tally.n
        for place in so_far["left_out"]:
            self._leave_out(place)
        self.people.print(f"going on from frame {high}", style="dim")

    # -- the frames ----------------------------------------------------------------------------

    def _run(self, held: Any) -> None:
        output = self.asked.output
        try:
            if self.unfinished is None:
                with closing(self._parts(held)) as parts:
                    self._join(parts, output.name)
                return
            for _ in self._parts(held):
                pass
            if self.error is None:
                with uninterrupted():
                    self._join(self.unfinished.parts(), output.name)
                    self._provenance()
                    self.unfinished.remove()
        except KeyboardInterrupt as error:
            self.interrupted = error
        except UsageError as error:  # a disc that is full: what was kept before is told
            self.error = error
        finally:
            self.bar.stop()

    def _parts(self, held: Any) -> Generator[bytes, None, None]:
        """Yield what each portion came to, and count it when that is written."""
        asked = self.asked
        try:
            self.feed.begin(self.low)
            if self.feed.irregular:
                self._refuse_state()
        except (UsageError, InOneRow):
            raise
        except Exception as error:  # a source may raise anything
            self.error = error
            return
        given = for_workers(self._job())
        with InOrder(asked.place, done, given, self._leave_out, self.left_out) as workers:
            again = True
            while again:
                again = False
                for portion, came in self._done(workers):
                    if came.irregular:
                        self.feed.send(came.irregular)
                        self._refuse_state()
                        workers.drop()
                        again = True
                        break
                    with held:
                        yield came.part
                        self._take(portion, came)
                    if came.error is not None:
                        self.error = came.error
                        return
        if self.low == asked.span.start and self.error is None:
            with held:
                yield self._without_frames(given)

    def _refuse_state(self) -> None:
        """Refuse to go on with frames that must be read from the start, where steps keep state.

        Raises
        ------
        InOneRow
        DataError
            If some of what was done is with others already.
        """
        if not (self.division.memory or self.division.by_recording):
            return
        begun = self.low > self.asked.span.start
        self.low = self.asked.span.start
        if begun and self.unfinished is None:
            told = f"{self.feed.irregular}; steps keep state: give -o FILE, or no --workers"
            raise DataError("workers", told)
        raise InOneRow(f"steps keep state, and {self.feed.irregular}")

    def _without_frames(self, given: bytes) -> bytes:
        """Return what the output is where no frame came."""
        if self.asked.span.start:
            got = self.ranges.n_frames if self.ranges else self.report.counts["frames"]
            start = self.asked.span.start
            raise UsageError(f"--frames {start}:…: the source gave only {got} frames")
        nothing = Portion(self.low, self.low, packed([]))
        came = done(given, nothing)
        self._take(nothing, came)
        return came.part

    def _done(self, workers: InOrder[Done]) -> Iterator[tuple[Portion, Done]]:
        try:
            yield from workers.results(self.feed.portions(self.low, workers.n_workers))
        except UsageError:
            raise
        except Exception as error:  # of the source, or of a cluster that is gone
            self.error = error

    def _job(self) -> Job:
        asked, source = self.asked, self.asked.pipeline.source
        reading = None
        if self.feed.in_place and source is not None:
            reading = Reading.of(source, self.division, asked.span.start)
        return Job(
            asked.pipeline, asked.outputs, asked.seed, asked.verify, asked.output.ending,
            asked.output.full, asked.output.long, reading, asked.span.start,
            is_long(asked.span.expected(self.report.n_expected)),
        )  # fmt: skip

    def _take(self, portion: Portion, came: Done) -> None:
        assert came.tally is not None  # it is no irregular one
        self.tally.join(came.tally)
        self.quantities |= came.quantities
        self.feed.size.took(came.n_frames, came.seconds)
        high = portion.high if came.error is None else portion.low + came.n_frames
        if self.unfinished is not None:
            so_far = {
                "tally": self.tally.kept(), "quantities": sorted(self.quantities),
                "left_out": self.left_out,
            }  # fmt: skip
            self.unfinished.add(high, came.part, so_far)
        self.low, self.n_kept = high, self.tally.n
        self.bar.at(self.tally.n, self.asked.span.expected(self.report.n_expected))

    def _leave_out(self, place: int) -> None:
        self.left_out.append(place)
        self.report.count("frames left out, of which workers died")
        self.report.trouble(f"frame {place}", KILLER)

    def _join(self, parts: Iterator[bytes], name: str) -> None:
        joined = self.asked.output.exporter.joined
        assert joined is not None  # or the frames would not have been divided
        if name == "-":
            joined(parts, piped(sys.stdout.buffer))
            return
        with whole_file(name, by="joined") as file:  # one run at a time: it holds the journal
            joined(parts, piped(file))
            self.n_bytes = file.tell() if file.seekable() else 0

    # -- the end -------------------------------------------------------------------------------

    def _close(self) -> int:
        self.feed.end(self.low)
        if self.tally.n or self.error is None:
            came = self.interrupted
            self.tally.close(self.people, self.report, words_of(came) if came else "")
            self._say_where()
        if self.error is not None:
            raise self.error
        if self.interrupted is not None:
            return code_of(self.interrupted)
        tally = self.tally
        failed = tally.n_failed or tally.n_items_failed or tally.not_finite or self.left_out
        return SOME_FAILED if failed else 0

    def _say_where(self) -> None:
        name = self.asked.output.name
        if self.interrupted is None and self.error is None:
            text = "" if name == "-" else f"wrote {name}"
        elif self.unfinished is not None and self.low > self.asked.span.start:
            text = f"{self.n_kept} frames are kept: --resume goes on with {name}"
        elif self.tally.n and not self.n_kept and name != "-":
            text = f"nothing of {name} is kept"
        else:
            text = ""
        if text:
            self.people.print(text, style="dim", soft_wrap=True)
        for text in filter(None, (self.without_unit, self.without_columns)):
            self.people.print(text, style="yellow", soft_wrap=True)

    def _provenance(self) -> None:
        asked = self.asked
        self.feed.end(self.low)
        units = None
        if asked.output.exporter.holds == "numbers":
            table = make_table(asked.pipeline, asked.outputs, asked.output.long)
            units = units_of(table, self.quantities)
            self.without_unit = without_one_unit(table, self.quantities)
            self.without_columns = without_columns(self.columns)
        data = provenance(
            asked.pipeline, asked.seed, self.report,
            command=["tactile-graph", *sys.argv[1:]], complete=True,
            asked=list(asked.outputs), columns=units,
            frames={"from": asked.span.start, "to": asked.span.stop}, result=self.tally.data(),
            made_of=self.of, bytes=self.n_bytes,
        )  # fmt: skip
        write_provenance(asked.output.name, data)
