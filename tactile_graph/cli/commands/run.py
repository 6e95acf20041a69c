"""``tactile-graph run``: frames through a pipeline, to people, to programs, to a picture."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tactile_graph.cli.app import EXIT_CODES
from tactile_graph.cli.arguments import (
    Span,
    open_pipeline,
    parse_span,
    pipeline_argument,
    source_options,
)
from tactile_graph.cli.endings import SOME_FAILED, exited
from tactile_graph.cli.interrupt import Interrupts, code_of, words_of
from tactile_graph.cli.leading import led
from tactile_graph.cli.many.options import Workers
from tactile_graph.cli.output.outputs import Output
from tactile_graph.cli.output.plot import IN_A_STRIP, Plot, check_plot, plot_of
from tactile_graph.cli.targets import check_targets
from tactile_graph.errors import DataError, UsageError
from tactile_graph.files import is_plain
from tactile_graph.plugins.registry import installed

if TYPE_CHECKING:
    from tactile_graph.api.pipeline import Pipeline
    from tactile_graph.api.result import Result
    from tactile_graph.engine.blocks.block import Block
    from tactile_graph.engine.blocks.gathering import Taken
    from tactile_graph.engine.tables.table import Table
    from tactile_graph.exporter import Writer
    from tactile_graph.wires.frame import Frame
    from tactile_graph.wires.frame_stack import FrameStack

STALLED_S = 1.0


@click.command(epilog=EXIT_CODES)
@pipeline_argument
@source_options
@click.option(
    "--frames",
    "span",
    callback=parse_span,
    metavar="N|A:B",
    help="Only the first N frames, or frames A up to B, counted from 0: those that a run of all "
    "gives, for steps that keep state see the frames before A first. A source that makes its "
    "frames makes as many.",
)
@click.option(
    "-o",
    "--output",
    metavar="FILE",
    help="Write a line a frame: out.jsonl, out.csv, out.parquet, or - for stdout; results/ for a "
    "Parquet data set with a part for each recording; or stacks of the images and masks asked for "
    "(--only): out.h5, out.zarr. How it was made is written beside it, as FILE.meta.json.",
)
@click.option(
    "--format",
    "form",
    metavar="FORMAT",
    help="Format of what is written, as a file's name would end (jsonl, csv, …; plugins may have "
    "more), where the name does not say; alone it means '-o -'.",
)
@click.option(
    "--full",
    is_flag=True,
    help="JSON lines with every field and array of the outputs, not only their summary.",
)
@click.option(
    "--long",
    is_flag=True,
    help="CSV and Parquet with a row a frame and object: every item of every list.",
)
@click.option(
    "--plot",
    metavar="FILE",
    help=f"Draw the first {IN_A_STRIP} frames, a row a frame, a column a node (.png, .svg, .pdf); "
    "or a film, what was found drawn over every frame (.gif, .mp4).",
)
@click.option(
    "--workers",
    type=Workers(),
    metavar="N|auto",
    help="Let N processes (auto: one for each core) work on the frames, for -o FILE; the file is "
    "the one that one process writes, and gets its name when it is whole.",
)
@click.option(
    "--on",
    metavar="ADDRESS",
    help="Where the workers are: a Dask cluster's scheduler (tcp://host:8786), or an executor that "
    "a plugin offers, NAME or NAME=ADDRESS.",
)
@click.option(
    "--resume",
    is_flag=True,
    help="Go on where a run with workers ended, if recordings, pipeline and options are the same.",
)
@click.option(
    "--decisions",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    metavar="FILE",
    help="Skip for the deadline what was skipped when FILE, JSON lines of a live run, was written, "
    "and answer the frames it answered: every answer is the same again.",
)
@click.option(
    "--verify",
    is_flag=True,
    help="Look after every step whether it wrote into what others read; slower.",
)
def run(
    pipeline: str | None,
    recordings: tuple[str, ...],
    source: str | None,
    source_settings: tuple[str, ...],
    settings: tuple[str, ...],
    seed: int,
    only: tuple[str, ...],
    span: Span,
    output: str | None,
    form: str | None,
    full: bool,
    long: bool,
    plot: str | None,
    workers: int | None,
    on: str | None,
    resume: bool,
    decisions: Path | None,
    verify: bool,
) -> None:
    """Run PIPELINE, a name or a YAML file, over recordings or another source.

    Without recordings and --source the pipeline's own source is used. People get a table on
    stdout, with errors where the truth is known; programs ask for lines with -o.
    """
    lines = Output.of(output, form, full, long)
    _check_files(lines, plot)
    divided = workers is not None or on is not None or resume
    if divided:
        _check_divided(lines, plot, decisions)
    opened = open_pipeline(pipeline, recordings, source, source_settings, settings, span)
    check_targets((("-o", lines.name if lines else None), ("--plot", plot)), [opened])
    one = _Run(opened, tuple(dict.fromkeys(only)), span, seed, lines, plot, verify, decisions)
    _tell_idle(opened, settings, one.only)
    _tell_unseen(opened, one.only)
    if divided:
        one.divided(workers, on, resume)
    one.go()


def _tell_idle(pipeline: Pipeline, settings: Sequence[str], asked: Sequence[str]) -> None:
    """Say which of the settings given change nothing."""
    if settings:
        from tactile_graph.cli.terminal import remark
        from tactile_graph.pipeline.idle import idle_settings

        names = [text.partition("=")[0].strip() for text in settings]
        for name in idle_settings(pipeline, names, asked):
            node = name.rpartition(".")[0]
            remark(f"--set {name}: changes nothing, for what is asked for does not need {node!r}")


def _tell_unseen(pipeline: Pipeline, asked: Sequence[str]) -> None:
    """Say which steps never see that what they follow has left."""
    from tactile_graph.pipeline.unseen import unseen_ends

    for told in unseen_ends(pipeline, asked):
        from tactile_graph.cli.terminal import remark

        remark(told)


def _check_files(output: Output | None, plot: str | None) -> None:
    """Refuse what could not be written in the end, before the work."""
    if output is not None:
        output.check()
    if plot is not None:
        check_plot(plot)


def _check_divided(output: Output | None, plot: str | None, decisions: Path | None) -> None:
    """Refuse what workers have no place for."""
    if decisions is not None:
        raise UsageError("--decisions: are followed by one process, without --workers")
    if output is None:
        raise UsageError("--workers, --on and --resume are for files: give -o FILE.jsonl")
    if plot is not None:
        raise UsageError("--plot: workers draw nothing; run the first frames without --workers")


@dataclass
class _Run:
    """One run from its first frame to its closing lines."""

    pipeline: Pipeline
    only: tuple[str, ...]
    span: Span
    seed: int
    output: Output | None
    plot: str | None
    verify: bool
    decisions: Path | None = None
    interrupted: KeyboardInterrupt | None = None
    form_of_table: Table | None = None
    quantities: set[str] = field(default_factory=set)
    last_frame_s: float = field(default_factory=time.monotonic)
    n_stalled: int = 0
    error: Exception | None = None
    written: bool = False
    """Whether the output was closed with all that was to go into it."""
    cut_short: bool = False
    """Whether an error ended the frames."""
    compiling: int | None = None
    """The process that still compiles when the frames are done."""
    made_of: dict[str, str] = field(default_factory=dict)
    """What the output hangs on, where it may be resumed."""

    def divided(self, workers: int | None, on: str | None, resume: bool) -> None:
        """Let workers run it, and leave the command; say why if they cannot."""
        from tactile_graph.cli.many.finished import is_done, refuse_other
        from tactile_graph.cli.many.many_run import Asked, InOneRow, ManyRun, division_for, hangs_on
        from tactile_graph.cli.many.options import BY_RECORDING, place_asked
        from tactile_graph.cli.terminal import console

        assert self.output is not None  # it is refused without
        place = place_asked(workers or (None if on else 1), on)
        assert place is not None  # one worker, if only --resume is given
        asked = Asked(
            self.pipeline, self.only, self.span, self.seed, self.output, self.verify, place, resume
        )
        division, ranges = division_for(asked)
        self.made_of = hangs_on(asked, division)
        say = console(stderr=True)
        if resume and is_done(self.pipeline, self.output, self.made_of):
            say.print(f"{self.output.name}: is done already", style="dim")
            click.get_current_context().exit(0)
        if division.why_not:
            if resume:
                refuse_other(self.output, self.made_of)
            say.print(f"in one process: {division.why_not}", style="yellow", soft_wrap=True)
            return
        if division.by_recording:
            say.print(BY_RECORDING, style="yellow", soft_wrap=True)
        try:
            code = ManyRun(asked, division, ranges, self.made_of).go()
        except InOneRow as why:
            say.print(f"in one process: {why}", style="yellow", soft_wrap=True)
            return
        click.get_current_context().exit(code)

    def go(self) -> None:
        from tactile_graph.cli.output.progress import Bar
        from tactile_graph.cli.output.tally import Tally
        from tactile_graph.cli.terminal import console, stdout_for_programs
        from tactile_graph.engine.deadlines.options import Recorded
        from tactile_graph.engine.tables.columns import columns_of
        from tactile_graph.steps.injected import Report

        self.report = Report(listener=self._trouble)
        self.recorded = None if self.decisions is None else Recorded()
        self.runner = self.pipeline.runner(self.only, self.seed, self.verify, self.recorded)
        self.asked = self.only or tuple(self.pipeline.outputs)
        self.columns = columns_of(self.pipeline, self.asked)
        self.tally = Tally(self.columns)
        # Lines own stdout; what is said to people then goes to stderr.
        self.people = console(stderr=self.output is not None)
        self.table: Any = None
        self.drawing: Plot | None = None
        if self.plot is not None:
            self.drawing = plot_of(self.plot, self.pipeline.name, self.asked)
        self.lines: Writer | None = None
        if self.output is not None:
            self.lines, self.form_of_table = self.output.writer(self.pipeline, self.asked)
        on_screen = self.lines is None and sys.stdout.isatty()
        self.stderr = console(stderr=True)
        self.bar = Bar(self.stderr, self.pipeline.name, shown=not on_screen)
        with Interrupts() as interrupts:
            with stdout_for_programs(self.output is not None and self.output.name == "-"):
                self._frames(interrupts)
            code = self._close()
        click.get_current_context().exit(code)

    # -- the frames --------------------------------------------------------------------------

    def _results(self) -> Iterator[Result | Block[Result]]:
        from tactile_graph.engine.blocks.gathering import WORTH_BLOCKS, Taken, flat, is_long

        in_blocks = self.lines is not None and self.drawing is None and self.runner.in_blocks
        source = self.pipeline.frames_in_stacks if in_blocks else self.pipeline.frames
        frames = self._decided(self._led(Taken(source(self.seed, self.report))))
        first = next(frames, None)
        if first is None:
            return
        expected = self.span.expected(self.report.n_expected)
        if is_long(expected):
            self._warm_up(expected)
        given = chain([first], frames)
        if in_blocks and (expected or 0) >= WORTH_BLOCKS:
            yield from self.pipeline.blocks(given, self.runner)
        else:
            yield from self.pipeline.results(flat(given), self.runner)

    def _led(self, frames: Taken) -> Iterator[Frame | FrameStack]:
        """Yield the frames asked for; steps that keep state have seen those before them."""
        runner = self.runner
        plan = None if self.decisions is not None else runner.plan  # of others no state has seen
        yield from led(frames, self.span, plan, runner, runner.block)
        self.report.counts["frames"] -= frames.n_left  # they came in a stack, and nobody asked

    def _decided(self, frames: Iterator[Frame | FrameStack]) -> Iterator[Frame | FrameStack]:
        """Return the frames that were decided about, if that is asked for."""
        from tactile_graph.engine.blocks.gathering import flat
        from tactile_graph.live.decisions import as_decided, decisions_in

        if self.decisions is None or self.recorded is None:
            return frames
        nodes = self.pipeline.nodes
        return as_decided(flat(frames), decisions_in(self.decisions, nodes), self.recorded)

    def _warm_up(self, expected: int | None) -> None:
        from tactile_graph.compiled import warm_up

        warm_up()
        self.bar.now(expected)

    def _frames(self, interrupts: Interrupts) -> None:
        from tactile_graph.compiled import answered_meanwhile

        try:
            with answered_meanwhile(self._still_compiling):
                for results in self._results():
                    interrupts.again()
                    with interrupts.held:
                        self._take(results)
        except KeyboardInterrupt as error:
            self.interrupted = error
        except BrokenPipeError:
            raise
        except Exception as error:  # a source may raise anything; what was done is kept
            self.error = error
        except BaseException as error:
            self.error = exited(error)
        finally:
            self.bar.stop()

    def _still_compiling(self, process: int) -> None:
        self.compiling = process

    def _trouble(self, where: str, what: str) -> None:
        """Tell a trouble at once when no frame comes: closing lines would be too late."""
        from tactile_graph.steps.injected import MOST_TOLD

        if time.monotonic() - self.last_frame_s <= STALLED_S:
            return
        self.n_stalled += 1
        if self.n_stalled <= MOST_TOLD:
            self.stderr.print(f"{where}: {what}", style="yellow", soft_wrap=True)

    def _take(self, results: Result | Block[Result]) -> None:
        self.last_frame_s, self.n_stalled = time.monotonic(), 0
        first = self.tally.n == 0
        from tactile_graph.engine.outcomes.outcomes import Outcomes

        if isinstance(results, Outcomes):
            self._one(results)
        else:
            self._several(results)
        if first and self._keeps():
            self._provenance(complete=False)  # should the run be killed
        self.bar.at(self.tally.n, self.span.expected(self.report.n_expected))

    def _one(self, result: Result) -> None:
        self.quantities.add(result.frame.image.quantity)
        if self.lines is not None:
            self.lines.write(result)  # before it counts: what cannot be written does not
        self.tally.add(result)
        if self.lines is None:
            self._row(result)
        if self.drawing is not None:
            self.drawing.add(result)

    def _several(self, block: Block[Result]) -> None:
        from tactile_graph.exporter import write_block

        assert self.lines is not None  # people are shown one frame after the other
        self.quantities.add(block.frames.images.quantity)
        write_block(self.lines, block)
        self.tally.add_block(block)

    def _row(self, result: Result) -> None:
        if self.table is None:
            from tactile_graph.cli.output.live_table import LiveTable

            self.people.print(self._heading(result), soft_wrap=True)
            self.table = LiveTable(self.people, self.columns, result)
        self.table.row(result)

    def _heading(self, result: Result) -> Any:
        from rich.text import Text

        image = result.frame.image
        pitch = " x ".join(f"{p:g}" for p in dict.fromkeys(image.pitch_cm))
        name = self.pipeline.source.name if self.pipeline.source else "frames"
        what = f"{image.rows} x {image.columns} cells of {pitch} cm, {image.quantity}"
        return Text.assemble((self.pipeline.name, "bold"), f" on {name}: {what}")

    # -- the end -----------------------------------------------------------------------------

    def _close(self) -> int:
        if self.error is None and not self.tally.n and not self.interrupted:
            self._no_frames()
        if self.tally.n or self.error is None:
            self._finish_lines()
            came = self.interrupted
            self.tally.close(self.people, self.report, words_of(came) if came else "")
            if self.runner.n_states == self.tally.n > 1:
                text = f"steps that keep state began anew with each of {self.tally.n} recordings"
                text += " of one frame; their folder is read as one recording"
                self.people.print(text, style="yellow", soft_wrap=True)
            drawn = self.drawing is not None and self.drawing.save(self.stderr)
            if self.drawing is not None:
                self.interrupted = came or self.drawing.interrupted
            self._hints(drawn)
        if self.error is not None:
            raise self.error  # the command line shows it; what was done stands above
        if self.interrupted is not None:
            return code_of(self.interrupted)
        tally = self.tally
        return SOME_FAILED if tally.n_failed or tally.n_items_failed or tally.not_finite else 0

    def _no_frames(self) -> None:
        got = self.report.counts["frames"]
        if self.span.start:
            self.error = UsageError(
                f"--frames {self.span.start}:…: the source gave only {got} frames"
            )
        elif not got and self._is_endless():  # of others, none may be all there are
            source = self.pipeline.source
            name = source.name if source is not None else "frames"
            counts = ", ".join(f"{n} {k}" for k, n in sorted(self.report.counts.items()) if n)
            told = "no frame came, and nothing was written" + (f" ({counts})" if counts else "")
            self.error = DataError(f"source {name!r}", told)

    def _keeps(self) -> bool:
        """Return whether what is written stays if the run ends here.

        Where the writer does not say it, the file tells: it is there, or is not yet.
        """
        if self.lines is None or self.output is None:
            return False
        return bool(getattr(self.lines, "keeps", Path(str(self._lies_at())).exists()))

    def _lies_at(self) -> str | None:
        """Return where what is written lies: beside an older output that stays."""
        return None if self.output is None else getattr(self.lines, "lies_at", self.output.name)

    def _is_endless(self) -> bool:
        """Return whether Ctrl-C is what ends the frames, as those of a pad at a port."""
        from tactile_graph.cli.many.made_of import device

        source = self.pipeline.source
        if device(self.pipeline):
            return True
        reads = source is not None and installed().has("readers", source.name)
        return not reads and self.span.expected(self.report.n_expected) is None

    def _finish_lines(self) -> None:
        """Close what is written and say beside it how it was made; the first trouble stands."""
        if self.lines is None:
            return
        from tactile_graph.exporter import close_early

        self.cut_short = self.error is not None
        early = self.cut_short or (self.interrupted is not None and not self._is_endless())
        try:
            close_early(self.lines) if early else self.lines.close()
            self.written = not getattr(self.lines, "broken", False)
        except BrokenPipeError:
            raise
        except Exception as error:
            self.error = self.error or error
        if not (self.written or self._keeps()):
            return  # there is nothing for a note to stand beside
        try:
            self._provenance(complete=self.error is None and not self.interrupted)
        except UsageError as error:
            if self.error is None:
                self.error = error
            elif str(error) != str(self.error):
                told = f"{error}: what it says is of the first frame"
                self.stderr.print(told, style="yellow", soft_wrap=True)

    def _provenance(self, complete: bool) -> None:
        from tactile_graph.provenance import provenance, write_provenance

        name = self._lies_at()
        if name in (None, "-") or not (is_plain(str(name)) or Path(str(name)).is_dir()):
            return  # nothing stands beside a pipe or a device
        resumed: dict[str, Any] = {}
        if self.made_of:
            from tactile_graph.cli.many.finished import n_bytes

            resumed = {"made_of": self.made_of, "bytes": n_bytes(str(name))}
        data = provenance(
            self.pipeline, self.seed, self.report,
            command=["tactile-graph", *sys.argv[1:]], complete=complete,
            asked=list(self.asked), columns=self._units(),
            frames={"from": self.span.start, "to": self.span.stop}, result=self.tally.data(),
            **resumed,
        )  # fmt: skip
        write_provenance(str(name), data)

    def _units(self) -> dict[str, str] | None:
        from tactile_graph.engine.tables.table import units_of

        table = self.form_of_table
        return None if table is None else units_of(table, self.quantities)

    def _hints(self, drawn: bool) -> None:
        say = self.people
        hidden = self.table.hidden if self.table is not None else []
        if hidden:
            names = ", ".join(c.key for c in hidden)
            say.print(f"not shown, for want of width: {names}; -o gives them", style="dim",
                      soft_wrap=True)  # fmt: skip
        if self.form_of_table is not None and self.written:
            from tactile_graph.engine.tables.table import without_columns, without_one_unit

            several = without_one_unit(self.form_of_table, self.quantities)
            for text in filter(None, (several, without_columns(self.columns))):
                say.print(text, style="yellow", soft_wrap=True)
        written = self._lies_at() if self.written else None
        from tactile_graph.cli.output.older import only_first

        only = only_first(self.tally.n) if self.cut_short else ""
        stays = getattr(self.lines, "stays", "") if self.written else ""
        for name, *more in ((written, only, stays), (self.plot if drawn else None,)):
            if name not in (None, "-"):
                lost = name == written and not Path(str(name)).exists()  # by a plugin's exporter
                wrote = f"no file {name} is there: none was written" if lost else f"wrote {name}"
                told = "; ".join(filter(None, (wrote, *more)))
                say.print(told, style="dim", soft_wrap=True)
        for note in self.drawing.notes() if self.drawing is not None and drawn else ():
            say.print(note, style="dim", soft_wrap=True)
        most = self.span.most if self.error is None else None
        if most is not None and self.tally.n < most and self.span.stop and not self.interrupted:
            say.print(f"the source ended after {self.tally.n} of {most} frames", style="dim")
        if self.compiling is not None:
            say.print(
                f"process {self.compiling} still compiles kernels, so that the next run is faster",
                style="dim", soft_wrap=True,
            )  # fmt: skip
