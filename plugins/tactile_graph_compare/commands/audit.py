"""``tactile-graph audit``: what each guard of a pipeline saves, and what error it brings in."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import click

from tactile_graph.cli.arguments import (
    Span,
    open_pipeline,
    parse_span,
    pipeline_argument,
    source_options,
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
from tactile_graph.cli.numbers import Finite
from tactile_graph.cli.targets import check_targets
from tactile_graph.errors import UsageError
from tactile_graph.files import check_target
from tactile_graph.foreign_text import visible
from tactile_graph_compare.commands.truth_option import no_truth_option

if TYPE_CHECKING:
    from tactile_graph.wires.frame import Frame
    from tactile_graph_compare.output.tables import Table
    from tactile_graph_compare.run.audit import Audit, Auditor, GuardAudit

EPILOG = """\b
Exit codes: 0 done, 1 frames are left out, of which workers died, 2 not done, 130 interrupted by
Ctrl-C, 143 ended by SIGTERM; what was done is shown.
"""


@click.command(epilog=EPILOG)
@pipeline_argument
@source_options
@click.option("--frames", "span", callback=parse_span, metavar="N|A:B",
              help="Only the first N frames, or frames A up to B, counted from 0; steps that keep "
              "state see the frames before A first.")  # fmt: skip
@click.option("--sample", type=Finite(0.0, 1.0, min_open=True), default=1.0,
              show_default=True, metavar="SHARE",
              help="Take this share of the frames, drawn at random; all where a step keeps "
              "state.")  # fmt: skip
@click.option("--json", "json_path", metavar="FILE.json", help="Write all figures as JSON, too.")
@no_truth_option
@workers_options
def audit(pipeline: str | None, recordings: tuple[str, ...], span: Span, **options: Any) -> None:
    """Tell what each guard of PIPELINE saves in time, and what error it brings in.

    On a sample of the frames all that a guard keeps from running is run besides, one guard at a
    time; so is every later choice of a first_of.
    """
    from tactile_graph.cli.terminal import console
    from tactile_graph_compare.run.audit import Auditor

    asked = _Options(**options)
    if asked.json_path is not None:
        check_target("--json", asked.json_path, (".json",))
    opened = open_pipeline(
        pipeline, recordings, asked.source, asked.source_settings, asked.settings, span
    )
    check_targets([("--json", asked.json_path)], [opened])
    auditor = Auditor(opened, tuple(asked.only), asked.sample, asked.seed)
    if not auditor.guards:
        raise UsageError(f"pipeline {opened.name!r} has no guard and no first_of to audit")
    shared = shared_for(asked.workers, asked.on, auditor.session.plan, opened, span.start)
    taking = _Taking(auditor, span, asked.seed, shared)
    interrupted = taking.go()
    found = auditor.summarise(interrupted is not None)
    if not found.n_frames:
        if interrupted is not None:
            raise interrupted
        if taking.n_left_out:
            raise UsageError(
                f"nothing to audit: workers died of each of {taking.n_left_out} frames"
            )
        raise UsageError(
            f"none of {found.n_seen} frames is in the sample of {asked.sample:g}: give a larger "
            "--sample"
        )
    out = console()
    _show(found, out, taking.n_left_out)
    if taking.shared is not None:
        out.print(side_by_side(taking.shared.place), style="dim", soft_wrap=True)
    if asked.json_path is not None:
        _write(found, asked.json_path, taking.n_left_out)
        out.print(f"wrote {asked.json_path}", style="dim", soft_wrap=True)
    if interrupted:
        out.print(words_of(interrupted), style="bold red")
        click.get_current_context().exit(code_of(interrupted))
    if taking.n_left_out:
        click.get_current_context().exit(SOME_FAILED)


@dataclass(frozen=True)
class _Options:
    """What the command line says beside pipeline and frames."""

    source: str | None
    source_settings: tuple[str, ...]
    settings: tuple[str, ...]
    seed: int
    only: tuple[str, ...]
    sample: float
    json_path: str | None
    workers: int | None
    on: str | None


@dataclass
class _Taking:
    """The frames of an audit, taken here or by workers.

    Attributes
    ----------
    shared : Shared or None
        Where workers are; None where the frames are taken here, after all maybe.
    n_left_out : int
        Frames of which workers died each time.
    """

    auditor: Auditor
    span: Span
    seed: int
    shared: Shared | None
    n_left_out: int = 0

    def go(self) -> KeyboardInterrupt | None:
        """Take the frames; return what ended them before their end, if anything did."""
        from tactile_graph.cli.interrupt import Interrupts
        from tactile_graph.cli.output.progress import Bar
        from tactile_graph.cli.terminal import console
        from tactile_graph.steps.injected import Report

        self.report = Report()
        bar = Bar(console(stderr=True), "audit")
        with Interrupts() as interrupts:
            try:
                for _ in self._taken(interrupts.held):
                    bar.at(self.auditor.n_seen, self.span.expected(self.report.n_expected))
            except KeyboardInterrupt as error:
                return error
            finally:
                bar.stop()
        return None

    def _taken(self, held: Any) -> Iterator[None]:
        """Take the frames; yield whenever some are done."""
        from tactile_graph.steps.ranges import Irregular

        if self.shared is not None:
            try:
                yield from self._by_workers(self.shared, held)
                return
            except Irregular as why:
                say_in_one_process(f"steps keep state, and {why}")
                self.shared = None
                with held:
                    self.auditor.begin()
        for frame in self._frames():
            with held:
                self.auditor.add(frame)
            yield

    def _frames(self) -> Iterator[Frame]:
        session = self.auditor.session
        frames = self.auditor.pipeline.frames(self.seed, self.report)
        return led_one_by_one(frames, self.span, session.plan, session.pass_over)

    def _by_workers(self, shared: Shared, held: Any) -> Iterator[None]:
        from tactile_graph.cli.say import say
        from tactile_graph.many import KILLER, Sharing
        from tactile_graph_compare.run.audit import AuditWorker
        from tactile_graph_compare.run.shared import N_BEFORE

        auditor = self.auditor
        given = auditor.for_workers(shared.reading(auditor.pipeline, self.span.start))
        where = Sourced(auditor.pipeline, self.seed, self.report, self.span)
        with Sharing(shared.place, AuditWorker, given) as workers:
            try:
                for part in shared.parts(workers, where, self._sample, N_BEFORE):
                    with held:
                        auditor.join(part)
                        if shared.in_place:
                            auditor.n_seen += part.session.n
                    yield
                    if part.error is not None:
                        raise part.error
            finally:
                self.n_left_out = len(workers.left_out)
                of = "" if shared.in_place else " of the sample"
                for number in workers.left_out:
                    say(f"frame {number}{of}: {KILLER}", err=True)

    def _sample(self) -> Iterator[Frame]:
        return (frame for frame in self._frames() if self.auditor.drawn())


def _show(found: Audit, out: Any, n_left_out: int) -> None:
    from rich.text import Text

    from tactile_graph_compare.output.shown import print_table
    from tactile_graph_compare.output.tables import left_out

    n, pipeline = found.n_frames, found.pipeline
    heading = f"{pipeline.name}, {n} of {found.n_seen} frames"
    heading += ": all, since a step keeps state" if found.whole else ""
    heading += f"; {died}" if (died := left_out(n_left_out, n)) else ""
    out.print(Text(f"{heading}; it takes {found.median_us:.1f} µs a frame (median)", style="bold"))
    gone: list[str] = []
    for table in (worth_table(found), error_table(found)):
        if table.rows:
            gone += [name for name in print_table(table, out) if name not in gone]
    if gone:
        text = f"not shown, for want of width: {', '.join(gone)}; --json gives all"
        out.print(text, style="dim", soft_wrap=True)


def worth_table(found: Audit) -> Table:
    """Return what each guard and hand-over saves and prevents."""
    from tactile_graph_compare.output.tables import Table

    columns = ("guard", "stopped", "saved", "share", "when it stops", "false", "failed", "changed")
    note = (
        "stopped: frames in which it kept something from running; saved: µs a frame, and as a "
        "share of the time without it; when it stops: µs in such a frame; false, failed: frames "
        "in which it prevents an answer where nothing lies, and a failure; changed: frames with "
        "another output"
    )
    rows = tuple(_row(g) for g in found.guards)
    return Table("What guards save", columns, rows, note, ("when it stops", "failed"))


def _row(guard: GuardAudit) -> tuple[str, ...]:
    from tactile_graph_compare.output.tables import signed_us, us

    return (
        _named(guard),
        str(guard.n_stopped),
        signed_us(guard.saved_us) if guard.saved_us < 0.0 else us(guard.saved_us),
        f"{100 * guard.saved_share:.0f} %",
        us(guard.saved_when_us) if guard.n_stopped else "",
        str(guard.n_false_prevented),
        str(guard.n_failed_prevented),
        str(guard.n_changed),
    )


def _named(guard: GuardAudit) -> str:
    return f"{guard.node} {guard.kind} {guard.text}"


def error_table(found: Audit) -> Table:
    """Return the error that guards bring in, those that change anything."""
    from tactile_graph_compare.output.tables import Table, named, signed

    rows = []
    for guard in found.guards:
        for d in guard.differences:
            if d.mean or d.n_only_variant or d.n_only_reference:
                bounds = (signed(x, d.unit) for x in (d.mean, d.low, d.high))
                counts = (d.n_both, d.n_only_reference, d.n_only_variant)
                name = _named(guard)
                rows.append((name, named(d.quantity, d.unit), *bounds, *map(str, counts)))
    columns = ("guard", "quantity", "mean", "95 % from", "to", "both", "lost", "won")
    note = (
        "mean absolute error it brings in where both answer; negative is better; lost, won: "
        "answers given only without it, only with it; no bounds where fewer than six frames differ"
    )
    return Table("What guards cost in error", columns, tuple(rows), note, ("95 % from", "to"))


def _write(found: Audit, path: str, n_left_out: int) -> None:
    from tactile_graph.files import write_whole

    data = {
        "pipeline": found.pipeline.name,
        "frames": found.n_frames,
        "frames_seen": found.n_seen,
        "frames_left_out": n_left_out,
        "median_us": found.median_us,
        "guards": [asdict(g) for g in found.guards],
        "provenance": found.everything.provenance,
    }
    write_whole(path, visible(json.dumps(data, indent=1, ensure_ascii=False)) + "\n")
