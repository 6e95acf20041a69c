"""``tactile-graph tune``: guards, the order of a ladder and settings, found by measurement."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tactile_graph.cli.arguments import (
    Span,
    open_pipeline,
    parse_span,
    pipeline_argument,
)
from tactile_graph.cli.completions import complete_set, complete_source, complete_with
from tactile_graph.cli.many.options import place_asked, side_by_side, workers_options
from tactile_graph.cli.numbers import Finite
from tactile_graph.cli.say import say
from tactile_graph.cli.targets import check_targets
from tactile_graph.cli.told_pads import reads_for_told_pads
from tactile_graph.errors import UsageError
from tactile_graph.files import check_target
from tactile_graph.foreign_text import visible

if TYPE_CHECKING:
    from tactile_graph import Pipeline
    from tactile_graph.steps.injected import Report
    from tactile_graph.wires.frame import Frame
    from tactile_graph_tune.tuned import Tuned

PICTURES = (".png", ".svg", ".pdf")
EPILOG = """\b
Without a goal it finds what is cheapest and, against the pipeline as it is, errs no more where
something lies, misses no more, and answers no more empty frames. Half of the frames choose, the
others report.

\b
  tactile-graph tune adaptive --frames 400 -o faster.yaml --plot front.png
  tactile-graph tune circle-3 film.npz --truth truth.csv --free footprint.level_v=0.005:0.05

\b
Exit codes: 0 done, 2 not done, 130 interrupted by Ctrl-C, 143 ended by SIGTERM.
"""


@click.command(epilog=EPILOG)
@pipeline_argument
@click.argument("recordings", metavar="[RECORDING]...", nargs=-1)
@click.option("--truth", type=click.Path(path_type=Path), metavar="FILE",
              help="What truly lay there, but for what is held out; it replaces what the "
              "recordings say of that.",
              )  # fmt: skip
@click.option("--held-out", multiple=True, metavar="RECORDING",
              help="Report on this recording, choose by the others; can be repeated.")  # fmt: skip
@click.option(
    "--source",
    metavar="STEP",
    shell_complete=complete_source,
    help="Take frames from this source step.",
)
@click.option("--with", "source_settings", metavar="KEY=VALUE", multiple=True,
              shell_complete=complete_with,
              help="A setting of the source; can be repeated.")  # fmt: skip
@click.option("--set", "settings", metavar="NODE.SETTING=VALUE", multiple=True,
              shell_complete=complete_set,
              help="A setting of a node instead of the file's; can be repeated.")  # fmt: skip
@click.option("--free", "free", metavar="NODE.SETTING=LOW:HIGH", multiple=True,
              help="Choose this setting too: LOW:HIGH, LOW:HIGH:COUNT or A,B,C; can be "
              "repeated.")  # fmt: skip
@click.option("--field", "fields", metavar="NODE.FIELD", multiple=True,
              help="Guards may ask this field and no others; can be repeated.")  # fmt: skip
@click.option("--keep", "kept", metavar="GUARD", multiple=True,
              help="Leave this condition, or the guard of this node, as it is; can be "
              "repeated.")  # fmt: skip
@click.option("--levels", is_flag=True,
              help="Choose only the numbers that guards compare with, and free settings: what "
              "guards ask, and the rungs, stay.")  # fmt: skip
@click.option("--answer", default="", metavar="OUTPUT",
              help="The output whose error counts; the first one otherwise.")  # fmt: skip
@click.option("--error", "quantity", metavar="QUANTITY",
              help="What of it counts: centre, radius, angle, identity, …; the first there is "
              "otherwise.")  # fmt: skip
@click.option("--price", type=Finite(min=0.0, min_open=True), metavar="ERROR",
              help="What a missed object counts; an answer off by it has missed.  "
              "[default: 2 cm, 45°, 1 for a wrong name]")  # fmt: skip
@click.option("--error-at-most", "most_error", type=Finite(min=0.0), metavar="ERROR",
              help="Find the cheapest whose mean error, where something lies, is no greater.  "
              "[default: as it is]")  # fmt: skip
@click.option("--margin", type=Finite(min=0.0), default=0.0, metavar="SHARE",
              help="Share by which the error may be greater than it is, where neither it nor the "
              "time is limited.  [default: 0]")  # fmt: skip
@click.option("--missed-at-most", "most_missed", type=Finite(0.0, 1.0), metavar="SHARE",
              help="Miss no more of the frames where something lies.  [default: as it is]",
              )  # fmt: skip
@click.option("--false-at-most", "most_false", type=Finite(0.0, 1.0), metavar="SHARE",
              help="Answer no more of the frames where nothing lies.  [default: as it is]",
              )  # fmt: skip
@click.option("--time-at-most", "most_us", type=Finite(min=0.0), metavar="µS",
              help="Find the least error that takes no longer, mean over the frames.")  # fmt: skip
@click.option("--frames", "span", callback=parse_span, metavar="N|A:B",
              help="Only the first N frames, or frames A up to B, counted from 0.")  # fmt: skip
@click.option("--share", "shares", metavar="KIND=SHARE", multiple=True,
              help="Of the frames to come this share is of this kind: 'empty', or a label (* for "
              "anything); can be repeated.  [default: as in the recordings]")  # fmt: skip
@click.option("--rounds", type=click.IntRange(min=1), default=3, show_default=True,
              help="How often every frame is run; times are medians.")  # fmt: skip
@click.option("--seed", type=click.IntRange(min=0), default=0, show_default=True,
              help="Seed of everything random.")  # fmt: skip
@click.option("-o", "--output", "written", metavar="FILE.yaml",
              help="Write the tuned pipeline; a file that is there stays.")  # fmt: skip
@click.option("--plot", metavar="FILE", help="Draw error against time (.png, .svg, .pdf).")
@click.option("--json", "json_path", metavar="FILE.json", help="Write all figures as JSON, too.")
@workers_options
def tune(pipeline: str | None, recordings: tuple[str, ...], span: Span, **options: Any) -> None:
    """Find the guards, the order of rungs and the settings of PIPELINE that are cheapest.

    Every node is run on every frame once; from what each took and how far off it was thousands of
    choices are weighed: comparisons with any node's field, the order of the first_of that answers,
    settings that the file marks free, or --free. Only the last few are run again.
    """
    from tactile_graph.cli.interrupt import Interrupts
    from tactile_graph.cli.output.progress import Bar
    from tactile_graph.cli.terminal import console, remark
    from tactile_graph.steps.injected import Report
    from tactile_graph_compare.run.crowded import Waiting, crowded
    from tactile_graph_tune.apart import check_recordings
    from tactile_graph_tune.commands.making import frames_of, how_made
    from tactile_graph_tune.request import Request, parse_free
    from tactile_graph_tune.shares import parse_share
    from tactile_graph_tune.tuner import tune as tuned_of

    asked = _Options(**options)
    _check_files(asked)
    check_recordings(recordings, asked.held_out)
    free = tuple(parse_free(text) for text in asked.free)
    shares = tuple(parse_share(text) for text in asked.shares)
    opened = open_pipeline(
        pipeline, recordings, asked.source, asked.source_settings, asked.settings, span
    )
    written = (("-o", asked.written), ("--plot", asked.plot), ("--json", asked.json_path))
    check_targets(written, [opened])
    request = Request(
        opened, asked.answer, asked.quantity, asked.price, asked.most_error, asked.most_missed,
        asked.most_false, asked.most_us, asked.margin, asked.fields, asked.kept, free, asked.levels,
        asked.rounds, asked.seed, shares, place_asked(asked.workers, asked.on),
        frames_of(opened, recordings, asked.held_out, asked.seed),
    )  # fmt: skip
    report, of_apart, waiting = Report(), Report(), Waiting()
    bar = Bar(console(stderr=True), "tune")
    try:
        with Interrupts():
            frames = _frames(opened, span, asked, report)
            apart = [f for name in asked.held_out for f in _recorded(opened, name, asked, of_apart)]
            found = tuned_of(request, frames, apart, lambda what, n, of: bar.at(n, of))
    except KeyboardInterrupt:
        say("nothing was chosen, and nothing written", err=True)
        raise
    finally:
        bar.stop()
    _show(found)
    for line in crowded(waiting) if request.place is None else ():
        remark(line)
    if request.place is not None:
        told = f"of the table {side_by_side(request.place)}"
        console().print(told, style="dim", soft_wrap=True)
    provenance = how_made(
        opened, span, asked.seed, report, held_out=dict(of_apart.digests), truth=asked.truth
    )
    for name in _written(found, asked, provenance):
        console().print(f"wrote {name}", style="dim", soft_wrap=True)


@dataclass(frozen=True)
class _Options:
    """What the command line says beside pipeline and frames."""

    truth: Path | None
    held_out: tuple[str, ...]
    source: str | None
    source_settings: tuple[str, ...]
    settings: tuple[str, ...]
    free: tuple[str, ...]
    fields: tuple[str, ...]
    kept: tuple[str, ...]
    levels: bool
    answer: str
    quantity: str | None
    price: float | None
    most_error: float | None
    most_missed: float | None
    most_false: float | None
    most_us: float | None
    margin: float
    shares: tuple[str, ...]
    rounds: int
    seed: int
    written: str | None
    plot: str | None
    json_path: str | None
    workers: int | None
    on: str | None


def _check_files(asked: _Options) -> None:
    """Refuse what could not be written in the end, before the work."""
    if asked.most_error is not None and asked.most_us is not None:
        raise UsageError("--error-at-most and --time-at-most: one of them is the goal, not both")
    if asked.margin and (asked.most_error, asked.most_us) != (None, None):
        raise UsageError("--margin: only where neither --error-at-most nor --time-at-most is given")
    if asked.written is not None:
        if not asked.written.endswith((".yaml", ".yml")):
            raise UsageError(f"-o {asked.written}: a pipeline file ends in .yaml")
        if Path(asked.written).exists():
            raise UsageError(f"-o {asked.written}: is there already; name another file")
        check_target("-o", asked.written)
    if asked.plot is not None:
        check_target("--plot", asked.plot, PICTURES, told_by_name=True)
    if asked.json_path is not None:
        check_target("--json", asked.json_path, (".json",))


def _frames(opened: Pipeline, span: Span, asked: _Options, report: Report) -> Sequence[Frame]:
    """Return the frames to choose by, with the truth that a file holds."""
    frames: Iterator[Frame] = opened.frames(asked.seed, report)
    if asked.truth is None:
        return list(span.of(frames))
    from tactile_graph_sources.readers.words.truth_file import with_truth

    with closing(with_truth(frames, asked.truth, report)) as known:
        return list(span.of(known))


def _recorded(opened: Pipeline, name: str, asked: _Options, report: Report) -> Iterator[Frame]:
    """Yield the frames of a recording that is held out."""
    from tactile_graph.cli.arguments import source_named

    named = source_named(opened, [name], None, (), Span())
    assert named is not None
    return reads_for_told_pads(opened.with_settings({}, named)).frames(asked.seed, report)


def _show(found: Tuned) -> None:
    from rich.text import Text

    from tactile_graph.cli.terminal import console
    from tactile_graph_compare.output.shown import print_table
    from tactile_graph_tune.output.tables import (
        doubt,
        front_table,
        guards_table,
        heading,
        points_table,
        settings_told,
        verdict,
    )

    out = console()
    out.print(Text(heading(found), style="bold"), soft_wrap=True)
    gone: list[str] = []
    for table in (points_table(found), front_table(found), guards_table(found)):
        if table.rows:
            gone += [n for n in (c.strip() for c in print_table(table, out)) if n not in gone]
    if gone:
        text = f"not shown, for want of width: {', '.join(gone)}; --json gives all"
        out.print(Text(text, style="dim"), soft_wrap=True)
    for told in settings_told(found):
        out.print(Text(told), soft_wrap=True)
    out.print(Text(verdict(found), style="bold"), soft_wrap=True)
    if doubt(found):
        out.print(Text(doubt(found), style="yellow"), soft_wrap=True)


def _written(found: Tuned, asked: _Options, provenance: dict[str, Any]) -> Iterator[str]:
    """Write the files asked for, and yield their names."""
    from tactile_graph.files import write_whole
    from tactile_graph.inspect import moved

    if asked.written is not None:
        own = found.pipeline
        write_whole(asked.written, moved(found.text, own.file, asked.written, own.registry))
        yield asked.written
    if asked.plot is not None:
        from tactile_graph_tune.output.figure import write_figure

        write_figure(found, asked.plot)
        yield asked.plot
    if asked.json_path is not None:
        from tactile_graph_tune.output.data import as_json

        write_whole(asked.json_path, visible(as_json(found, provenance)))
        yield asked.json_path
