"""``tactile-graph learn``: readings of an object into the database."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tactile_graph.cli.arguments import Span, open_pipeline, parse_span, source_options
from tactile_graph.cli.endings import SOME_FAILED
from tactile_graph.cli.say import say
from tactile_graph.errors import UsageError
from tactile_graph_classifiers.commands.shared import database_option, tell_apart
from tactile_graph_classifiers.measuring.shapes import SHAPES

if TYPE_CHECKING:
    from tactile_graph.api.pipeline import Pipeline
    from tactile_graph_classifiers.measuring.measurements import Measurements


@click.command()
@click.argument("name")
@source_options
@database_option
@click.option("--pipeline", default="describe", show_default=True,
              help="Which pipeline measures the features: a name or a YAML file.")  # fmt: skip
@click.option("--shape", type=click.Choice(SHAPES),
              help="What its footprint is; the recording's truth says it otherwise.")  # fmt: skip
@click.option("--frames", "span", callback=parse_span, metavar="N|A:B",
              help="Only the first N frames, or frames A up to B, counted from 0.")  # fmt: skip
def learn(
    name: str,
    recordings: tuple[str, ...],
    source: str | None,
    source_settings: tuple[str, ...],
    settings: tuple[str, ...],
    seed: int,
    only: tuple[str, ...],
    database: Path,
    timeout_s: float,
    pipeline: str,
    shape: str | None,
    span: Span,
) -> None:
    """Learn the object NAME from recordings in which it alone lies on the pad.

    Each frame is a reading. Readings of an object that is known are added to it; all are learned
    or none. What the pipeline calls an empty pad is left out. How the objects are told apart best
    is found by leaving readings and objects out, and how well that did is said.
    """
    from tactile_graph.compiled import answered_meanwhile
    from tactile_graph_classifiers.database.rows import Lesson, Setting
    from tactile_graph_classifiers.database.store import ObjectDatabase

    if not recordings and source is None:
        raise UsageError("name the recordings to learn from, or a --source")
    opened = open_pipeline(pipeline, recordings, source, source_settings, settings, span)
    with answered_meanwhile():
        read = _Read(opened, only, seed, span)
    first = read.rows[0]
    readings = [m.values.tolist() for m in read.rows]
    lesson = Lesson(name, shape or read.shape, readings, read.sources)  # type: ignore[arg-type]
    store = ObjectDatabase(database, timeout_s)
    store.learn(Setting(first.names, first.quantity, opened.name), [lesson])
    total = next(s for s in store.summaries() if s.name == " ".join(name.split()))
    say(
        f"{database}: {total.name}{f' ({total.shape})' if total.shape else ''}: "
        f"{len(read.rows)} readings learned, {total.n_readings} in all"
    )
    tell_apart(store)
    for what, n in read.left_out.items():
        say(f"left out: {n} frames: {what}", err=True)
    for where, what in read.troubles:
        say(f"{where}: {what}", err=True)
    if read.n_failed:
        click.get_current_context().exit(SOME_FAILED)


class _Read:
    """The readings a pipeline makes of its source, and what came in between."""

    def __init__(self, pipeline: Pipeline, only: tuple[str, ...], seed: int, span: Span) -> None:
        from tactile_graph.engine.outcome import Failed, Skipped
        from tactile_graph.steps.injected import Report
        from tactile_graph_classifiers.measuring.shapes import true_shape

        self.rows: list[Measurements] = []
        self.sources: list[str] = []
        self.left_out: Counter[str] = Counter()
        self.n_failed = 0
        output = measuring_output(pipeline, only)
        report = Report()
        shapes = set()
        runner = pipeline.runner([output], seed)
        for frame in span.of(pipeline.frames(seed, report)):
            outcome: Any = runner(frame).outcome(output)
            if isinstance(outcome, Failed | Skipped):
                self.left_out[_why(outcome.reason)] += 1
                self.n_failed += isinstance(outcome, Failed)
                continue
            self.rows.append(getattr(outcome, "measurements", outcome))
            self.sources.append(_source(pipeline, frame))
            shapes.add(true_shape(frame))
        self.troubles = report.troubles
        self.shape = shapes.pop() if len(shapes) == 1 else ""
        if not self.rows:
            why = "; ".join(f"{n} frames: {what}" for what, n in self.left_out.most_common(3))
            raise UsageError(f"nothing to learn: no frame gave a reading ({why or 'no frames'})")


def _why(reason: str) -> str:
    """Return a reason without what was read in this one frame, so that like ones are counted."""
    condition, is_false, _ = reason.partition(" is false (")
    return condition + " is false" if is_false else reason


def _source(pipeline: Pipeline, frame: Any) -> str:
    source = pipeline.source
    path = source.settings.get("path", source.name) if source is not None else ""
    where = ", ".join(map(str, path)) if isinstance(path, list) else str(path)
    return " ".join(t for t in (where, frame.label, f"frame {frame.index}") if t)


def measuring_output(pipeline: Pipeline, only: tuple[str, ...]) -> str:
    """Return the output, or the node asked for, that gives measurements.

    Parameters
    ----------
    pipeline : Pipeline
    only : tuple of str
        Nodes asked for instead of the outputs.

    Raises
    ------
    UsageError
        If none does.
    """
    from tactile_graph.pipeline.wiring import fit
    from tactile_graph_classifiers.measuring.measurements import Measurements

    asked = only or tuple(pipeline.outputs)
    for name in asked:
        ref = pipeline.ref(name) if only else pipeline.outputs[name]
        if fit(ref, pipeline.type_of(ref), Measurements) is not None:
            return name
    raise UsageError(
        f"pipeline {pipeline.name!r} gives no measurements, but {', '.join(asked)}; name another"
        " --pipeline, or its node with --only"
    )
