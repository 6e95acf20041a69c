"""``tactile-graph compare``: variants side by side, on the same frames, against the same truth."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tactile_graph.cli.arguments import Span, parse_span
from tactile_graph.cli.completions import (
    complete_node,
    complete_pipeline,
    complete_set,
    complete_source,
    complete_with,
)
from tactile_graph.cli.endings import SOME_FAILED
from tactile_graph.cli.interrupt import code_of, words_of
from tactile_graph.cli.leading import led_one_by_one
from tactile_graph.cli.many.options import (
    Shared,
    Sourced,
    say_in_one_process,
    shared_for,
    side_by_side,
    workers_options,
)
from tactile_graph.cli.targets import check_targets
from tactile_graph.cli.told_pads import reads_for_told_pads
from tactile_graph.errors import UsageError
from tactile_graph.files import check_target
from tactile_graph.foreign_text import visible
from tactile_graph.plugins import registry
from tactile_graph_compare.commands.truth_option import no_truth_option

if TYPE_CHECKING:
    from tactile_graph.steps.injected import Report
    from tactile_graph.wires.frame import Frame
    from tactile_graph_compare.records.comparison import Comparison
    from tactile_graph_compare.run.session import Session
    from tactile_graph_compare.variants.prepare import PreparedVariant
    from tactile_graph_compare.variants.request import VariantRequest

ENDINGS = {"--markdown": (".md", ".markdown"), "--json": (".json",), "--report": (".html",)}
EPILOG = """\b
A variant is a pipeline's name or file, or one with settings, as one quoted word:
  tactile-graph compare circle-3 "circle-3 --set footprint.level_v=0.02"
A sweep makes a variant of each value:
  tactile-graph compare circle-3 --sweep footprint.level_v=0.005:0.03:0.0025

\b
Exit codes:
  0    done
  1    frames are left out, of which workers died
  2    not done: wrong usage, a wrong pipeline file, a file that cannot be read
  130  interrupted by Ctrl-C; what was done is shown and written
  143  ended by SIGTERM (129: its terminal was closed); likewise
"""


@click.command(epilog=EPILOG)
@click.argument("variants", nargs=-1, metavar="VARIANT... [RECORDING]...",
                shell_complete=complete_pipeline)  # fmt: skip
@click.option(
    "--source",
    metavar="STEP",
    shell_complete=complete_source,
    help="Take frames from this source step.",
)
@click.option("--with", "source_settings", metavar="KEY=VALUE", multiple=True,
              shell_complete=complete_with,
              help="A setting of the source; can be repeated.")  # fmt: skip
@click.option("--frames", "span", callback=parse_span, metavar="N|A:B",
              help="Only the first N frames, or frames A up to B, counted from 0; steps that keep "
              "state see the frames before A first.")  # fmt: skip
@click.option("--set", "settings", metavar="NODE.SETTING=VALUE", multiple=True,
              shell_complete=complete_set,
              help="A setting of every pipeline that has it; can be repeated.")  # fmt: skip
@click.option("--sweep", "sweeps", metavar="NODE.SETTING=VALUES", multiple=True,
              help="Values of a setting in turn, START:STOP:STEP (stop included) or A,B,C, for "
              "every pipeline that has it; several go side by side.")  # fmt: skip
@click.option("--product", is_flag=True, help="Cross every value of a sweep with every other's.")
@click.option("--lineage", is_flag=True,
              help="Compare the pipelines that those named evolved from, too.")  # fmt: skip
@click.option("--reference", default="", metavar="VARIANT",
              help="Hold every other variant against this one: how far they agree in every frame, "
              "and, where the truth is known, whose errors are smaller. Without it agreement is "
              "told where nobody knows the truth.")  # fmt: skip
@click.option("--seed", type=click.IntRange(min=0), default=0, show_default=True,
              help="Seed of everything random.")  # fmt: skip
@click.option("--only", metavar="NODE", multiple=True, shell_complete=complete_node,
              help="Ask every variant for this node or node.field instead of its outputs; can be "
              "repeated.")  # fmt: skip
@click.option("--csv", "csv_path", metavar="FILE|FOLDER",
              help="Write errors frame by frame to FILE.csv; or these, times, scores and "
              "differences to a folder.")  # fmt: skip
@click.option("--markdown", metavar="FILE.md", help="Write the tables as Markdown; - for stdout.")
@click.option("--json", "json_path", metavar="FILE.json",
              help="Write all figures and how they were made; - for stdout.")  # fmt: skip
@click.option("--report", metavar="FILE.html", help="Write a report to look at in a browser.")
@no_truth_option
@workers_options
def compare(variants: tuple[str, ...], span: Span, **options: Any) -> None:
    """Compare VARIANTs, two or more, on the same frames: errors, times, lineage.

    Nodes that variants have in common run once. Without recordings and --source all take the
    frames of the first one's own source.
    """
    from tactile_graph.cli.interrupt import Interrupts

    asked = _Options(**options)
    _check_files(asked)
    prepared, notes = _prepared(variants, span, asked)
    check_targets(asked.targets, [variant.pipeline for variant in prepared])
    with Interrupts() as interrupts:
        code = _Run(prepared, notes, span, asked).go(interrupts.held)
    click.get_current_context().exit(code)


@dataclass(frozen=True)
class _Options:
    """What the command line says beside variants and frames."""

    source: str | None
    source_settings: tuple[str, ...]
    settings: tuple[str, ...]
    sweeps: tuple[str, ...]
    product: bool
    lineage: bool
    reference: str
    seed: int
    only: tuple[str, ...]
    csv_path: str | None
    markdown: str | None
    json_path: str | None
    report: str | None
    workers: int | None
    on: str | None

    @property
    def files(self) -> dict[str, str]:
        """Option -> file, of those given."""
        named = {"--csv": self.csv_path, "--markdown": self.markdown, "--json": self.json_path,
                 "--report": self.report}  # fmt: skip
        return {k: v for k, v in named.items() if v is not None}

    @property
    def targets(self) -> Iterator[tuple[str, str]]:
        """Yield option and file, for every file that is written."""
        from tactile_graph_compare.output.export import csv_files

        for option, name in self.files.items():
            if option == "--csv" and not Path(name).is_dir():
                yield option, name
                continue
            names = csv_files(name) if option == "--csv" else [name]
            yield from ((option, str(one)) for one in names)


def _check_files(options: _Options) -> None:
    """Refuse what could not be written in the end, before the work."""
    files = options.files
    if list(files.values()).count("-") > 1:
        raise UsageError("only one of --markdown and --json can go to stdout")
    for option, name in files.items():
        if name == "-":
            if option in ("--csv", "--report"):
                raise UsageError(f"{option} -: name a file; stdout is for --markdown and --json")
            continue
        if option == "--csv":
            _check_csv(name)
        else:
            check_target(option, name, ENDINGS[option])


def _check_csv(name: str) -> None:
    """Refuse what is neither a file.csv nor a folder, or a name for one."""
    path = Path(name)
    if path.is_dir():
        check_target("--csv", path / "errors.csv")
        return
    if path.suffix.lower() != ".csv":
        if path.exists():
            raise UsageError(f"--csv {name}: is a file; its name must end in .csv")
        if path.suffix[1:2].isalpha() and os.path.basename(name):
            raise UsageError(
                f"--csv {name}: must be a file whose name ends in .csv, or a folder; to make a "
                f"folder of that name, write {name}/"
            )
    check_target("--csv", path)


# -- what to compare -------------------------------------------------------------------------


def _prepared(
    words: Sequence[str], span: Span, options: _Options
) -> tuple[list[PreparedVariant], list[str]]:
    from tactile_graph.cli.arguments import offered, source_named
    from tactile_graph.pipeline.document import assignment
    from tactile_graph_compare.variants.one_source import first_source, on_source
    from tactile_graph_compare.variants.prepare import prepare
    from tactile_graph_compare.variants.sweeps import parse_sweep

    requests, recordings = _told_apart(words)
    if not requests:
        raise UsageError(f"name the pipelines to compare, or files of them\n{offered()}")
    if options.only:
        requests = [r if r.only else replace(r, only=options.only) for r in requests]
    prepared = prepare(
        requests,
        registry.installed(),
        dict(assignment("--set", s) for s in options.settings),
        [parse_sweep(s) for s in options.sweeps],
        options.product,
        options.lineage,
    )
    base, notes = prepared[0], list[str]()
    if not recordings and options.source is None:
        base, notes = first_source(prepared)
    named = source_named(base.pipeline, recordings, options.source, options.source_settings, span)
    placed = base.pipeline.with_settings({}, named) if named else base.pipeline
    placed = reads_for_told_pads(placed, [variant.pipeline for variant in prepared])
    assert placed.source is not None
    return on_source(prepared, placed.source.name, placed.source.given), notes


def _told_apart(words: Sequence[str]) -> tuple[list[VariantRequest], list[str]]:
    """Return the variants and the recordings among the words of a command line."""
    from tactile_graph_compare.variants.request import parse_request, words_of

    found = registry.installed()
    requests: list[VariantRequest] = []
    recordings: list[str] = []
    for word in words:
        try:
            name = next(iter(words_of(word)), "")
        except ValueError:  # a quotation that does not end
            name = word
        if found.has("pipelines", name) or name.endswith((".yaml", ".yml")):
            requests.append(parse_request(word, found))
        elif Path(word).exists():
            recordings.append(word)
        else:
            raise UsageError(f"no file {word!r}, and {found.unknown('pipelines', name)}")
    return requests, recordings


# -- the frames ------------------------------------------------------------------------------


class _Run:
    """One comparison from its first frame to its files."""

    def __init__(
        self, prepared: list[PreparedVariant], notes: list[str], span: Span, options: _Options
    ) -> None:
        from tactile_graph.cli.terminal import console
        from tactile_graph.steps.injected import Report
        from tactile_graph_compare.run.session import Session
        from tactile_graph_compare.variants.prepare import referred

        self.options = options
        self.span = span
        self.notes = notes
        self.report: Report = Report()
        self.n_left_out = 0
        reference = options.reference and referred(prepared, options.reference)
        self.session: Session = Session(prepared, options.seed, reference=reference)
        self.pipeline = prepared[0].pipeline
        self.shared = shared_for(
            options.workers, options.on, self.session.plan, self.pipeline, span.start
        )
        # What is written to stdout for programs owns it; people are then told on stderr.
        self.people = console(stderr="-" in options.files.values())
        self.stderr = console(stderr=True)

    def go(self, held: Any) -> int:
        from tactile_graph.cli.terminal import stdout_for_programs

        with stdout_for_programs("-" in self.options.files.values()):
            interrupted, error = self._frames(held)
        with held:
            if self.session.n:
                self._finish(interrupted)
            elif interrupted is not None:
                self.people.print(f"{words_of(interrupted)} before any frame", style="bold red")
            elif error is None:
                got = f"the source gave {self.report.counts['frames']} frames"
                died = f"workers died of each of {self.n_left_out} frames"
                why = died if self.n_left_out else got
                error = UsageError(f"there is nothing to compare: {why}")
        if error is not None:
            raise error
        if interrupted is not None:
            return code_of(interrupted)
        return SOME_FAILED if self.n_left_out else 0

    def _frames(self, held: Any) -> tuple[KeyboardInterrupt | None, Exception | None]:
        from tactile_graph.cli.output.progress import Bar

        bar = Bar(self.stderr, "compare")
        try:
            bar.now(self.span.expected(None))
            for _ in self._noted(held):
                bar.at(self.session.n, self.span.expected(self.report.n_expected))
        except KeyboardInterrupt as error:
            return error, None
        except Exception as error:  # a source may raise anything; what was done is shown
            return None, error
        finally:
            bar.stop()
        return None, None

    def _source(self) -> Iterator[Frame]:
        frames = self.pipeline.frames(self.options.seed, self.report)
        return led_one_by_one(frames, self.span, self.session.plan, self.session.pass_over)

    def _noted(self, held: Any) -> Iterator[None]:
        """Note the frames, here or by workers; yield whenever some are done."""
        from tactile_graph.steps.ranges import Irregular

        if self.shared is not None:
            try:
                yield from self._noted_by_workers(self.shared, held)
                return
            except Irregular as why:
                say_in_one_process(f"steps keep state, and {why}")
                self.shared = None
                with held:
                    self.session.begin()
        for frame in self.session.warmed(self._source()):
            with held:
                self.session.add(frame)
            yield

    def _noted_by_workers(self, shared: Shared, held: Any) -> Iterator[None]:
        from tactile_graph.many import KILLER, Sharing
        from tactile_graph_compare.run.shared import N_BEFORE, Given, SessionWorker

        session = self.session
        reading = shared.reading(self.pipeline, self.span.start)
        given = Given(session.prepared, session.seed, session.reference, reading)
        where = Sourced(self.pipeline, self.options.seed, self.report, self.span)
        with Sharing(shared.place, SessionWorker, given) as workers:
            try:
                for part, error in shared.parts(workers, where, self._source, N_BEFORE):
                    with held:
                        session.join(part)
                    yield
                    if error is not None:
                        raise error
            finally:
                self.n_left_out = len(workers.left_out)
                first = 0 if shared.in_place else self.span.start
                for number in workers.left_out:
                    self.report.trouble(f"frame {first + number}", KILLER)

    # -- the end -----------------------------------------------------------------------------

    def _finish(self, interrupted: KeyboardInterrupt | None) -> None:
        from tactile_graph_compare.output.shown import show
        from tactile_graph_compare.run.summarise import summarise

        notes = self.notes
        if self.shared is not None:
            notes = [*notes, side_by_side(self.shared.place)]
        comparison = summarise(
            self.session,
            self.report,
            interrupted is not None,
            notes,
            self.span.start,
            self.n_left_out,
        )
        if interrupted is not None:
            n = self.session.n
            frames = f"{n} frame{'s' if n != 1 else ''}"
            self.people.print(f"{words_of(interrupted)} after {frames}", style="bold red")
        try:
            show(comparison, self.people)
            for line in self.report.few_troubles():
                self.people.print(f"source   {line}", style="cyan", soft_wrap=True)
        finally:  # whoever reads along may go away (| head); the files are wanted all the same
            written = list(self._written(comparison))
        for name in written:
            self.people.print(f"wrote {name}", style="dim", soft_wrap=True)

    def _written(self, comparison: Comparison) -> Iterator[str]:
        """Write the files asked for, and yield their names."""
        from tactile_graph_compare.output.export import as_json, write_csv
        from tactile_graph_compare.output.tables import markdown

        options = self.options
        if options.csv_path is not None:
            yield from write_csv(comparison, options.csv_path)
        for name, text in ((options.markdown, markdown), (options.json_path, as_json)):
            yield from _put(name, visible(text(comparison))) if name is not None else ()
        if options.report is not None:
            _report_writer()(comparison, options.report)
            yield options.report


def _put(name: str, text: str) -> Iterator[str]:
    from tactile_graph.files import write_whole

    if name == "-":
        sys.stdout.write(text)
        return
    write_whole(name, text)
    yield name


def _report_writer() -> Any:
    from importlib import import_module

    try:
        return import_module("tactile_graph_compare.report").write_report
    except ImportError as error:
        raise UsageError(f"--report: this installation cannot write reports ({error})") from None
