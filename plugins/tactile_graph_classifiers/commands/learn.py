"""``tactile-graph learn``: readings of an object into the database."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click
import numpy as np

from tactile_graph.cli.arguments import Span, open_pipeline, parse_span, source_options
from tactile_graph.cli.endings import SOME_FAILED
from tactile_graph.cli.many.options import place_for, workers_options
from tactile_graph.cli.say import say
from tactile_graph.errors import UsageError
from tactile_graph.foreign_text import pasted
from tactile_graph_classifiers.commands.shared import database_option, tell_apart, tell_assumed_pad
from tactile_graph_classifiers.measuring.shapes import SHAPES

if TYPE_CHECKING:
    from tactile_graph.api.pipeline import Pipeline
    from tactile_graph.many import Place
    from tactile_graph.pipeline.wiring import Ref
    from tactile_graph.steps.injected import Report
    from tactile_graph_classifiers.database.known import Known
    from tactile_graph_classifiers.measuring.reader import Given, Readings


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
@click.option("--keep-presses", is_flag=True,
              help="Keep the images too: 'tactile-graph learn-reliefs' learns reliefs of"
                   " them.")  # fmt: skip
@workers_options
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
    keep_presses: bool,
    workers: int | None,
    on: str | None,
) -> None:
    """Learn the object NAME from recordings in which it alone lies on the pad.

    Each frame is a reading. Readings of an object that is known are added to it; all are learned
    or none. What the pipeline calls an empty pad is left out. How the objects are told apart best
    is found by leaving readings and objects out, and how well that did is said.
    """
    from tactile_graph.steps.injected import Report
    from tactile_graph_classifiers.database.names import known_as, plain_name
    from tactile_graph_classifiers.database.rows import Lesson, Setting
    from tactile_graph_classifiers.database.store import ObjectDatabase
    from tactile_graph_classifiers.measuring.reader import Given

    if not recordings and source is None:
        raise UsageError("name the recordings to learn from, or a --source")
    opened = open_pipeline(pipeline, recordings, source, source_settings, settings, span)
    output = measuring_output(opened, only)
    asked = Given(opened, output, seed, image_of(opened, output, only) if keep_presses else None)
    place = place_for(workers, on, opened.runner([asked.output], seed).plan)
    report = Report()
    try:
        read = _read(opened, asked, span, place, report)
    except KeyboardInterrupt:
        say("nothing was learned: all readings are, or none", err=True)
        raise
    if not read.rows:
        why = "; ".join(f"{n} frames: {what}" for what, n in read.left_out.most_common(3))
        raise UsageError(f"nothing to learn: no frame gave a reading ({why or 'no frames'})")
    first = read.rows[0]
    readings = [m.values.tolist() for m in read.rows]
    lesson = Lesson(name, shape or read.shape, readings, read.sources)  # type: ignore[arg-type]
    store = ObjectDatabase(database, timeout_s)
    presses = {name: read.presses} if keep_presses else None
    instrument, *others = read.instruments
    for other in others:
        if not other.same_pitch(instrument):
            raise UsageError(
                f"these recordings are of {instrument} and of {other}; learn those of one"
                " instrument into a database of their own"
            )
    setting = Setting(first.names, first.quantity, opened.name, instrument)
    twice = store.learn(setting, [lesson], presses=presses)
    known = store.known()
    kept_as = known_as(plain_name(name), known.names)
    total = next(s for s in store.summaries() if s.name == kept_as)
    say(
        f"{database}: {total.name}{f' ({total.shape})' if total.shape else ''}: "
        f"{len(read.rows)} readings learned, {total.n_readings} in all"
    )
    if twice:
        again = f"tactile-graph forget {pasted(total.name)}"
        say(
            f"{twice} of these were learned before, from the same frames or a copy of them, and "
            f"count twice now; "
            f"{again} begins anew",
            err=True,
        )
    for other in read.instruments:
        if known.instrument is not None and not other.same_as(known.instrument):
            say(f"these are readings of {other}, the first in {database} of {known.instrument}:"
                " do they compare?", err=True)  # fmt: skip
    if read.by_law:
        tell_assumed_pad(opened, settings)
    tell_apart(store)
    if total.n_readings == len(read.rows):
        _say_namesakes(store.known(), total.name)
    for what, n in read.left_out.items():
        say(f"left out: {n} frames: {what}", err=True)
    for line in report.few_troubles():
        say(line, err=True)
    if read.n_failed:
        click.get_current_context().exit(SOME_FAILED)


def _say_namesakes(known: Known, name: str) -> None:
    """Say of a new object which others differ from it by case, spaces and signs alone."""
    for other in known.names:
        if other != name and _letters(other) == _letters(name):
            again = f"tactile-graph forget {pasted(name)}"
            say(f"{name!r} is a new object beside {other!r}{_alike(known, name, other)}; did you"
                f" mean {other!r}? Then {again}, and learn it as that", err=True)  # fmt: skip


def _letters(name: str) -> str:
    return "".join(c for c in name.casefold() if c.isalnum())


def _alike(known: Known, name: str, other: str) -> str:
    """Return how often readings of two objects are taken for the other when left out, in words."""
    from tactile_graph_classifiers.distances.choosing import left_out_names
    from tactile_graph_classifiers.distances.examples import Examples

    if known.choice is None:
        return ""
    both = [known.names.index(one) for one in (name, other)]
    true, named = left_out_names(Examples.of(known), known.choice.manner)
    of_both = np.isin(true, both)
    n, n_mixed = int(of_both.sum()), int((np.isin(named, both) & of_both & (named != true)).sum())
    if not n:
        return ""
    # Of two that are the same, half are, but for chance.
    same = ", so they look the same" if 4 * n_mixed >= n and not known.few else ""
    return f", {n_mixed} of whose {n} readings are named as the other when left out{same}"


def _read(
    pipeline: Pipeline, given: Given, span: Span, place: Place | None, report: Report
) -> Readings:
    """Return the readings a pipeline makes of its source, here or by workers."""
    from tactile_graph.many import KILLER, Sharing
    from tactile_graph_classifiers.measuring.reader import Reader, Readings

    frames = span.of(pipeline.frames(given.seed, report))
    if place is None:
        return Reader(given).readings(frames)
    found = Readings()
    with Sharing(place, Reader, given) as workers:
        for readings in workers.over_frames(frames):
            found.join(readings)
        found.n_failed += len(workers.left_out)
        for number in workers.left_out:
            report.trouble(f"frame {span.start + number}", KILLER)
    return found


def image_of(pipeline: Pipeline, output: str, only: tuple[str, ...]) -> Ref:
    """Return where the image stands that an output measures.

    Parameters
    ----------
    pipeline : Pipeline
    output : str
        As `measuring_output` has it.
    only : tuple of str
        Nodes asked for instead of the outputs.

    Raises
    ------
    UsageError
        If it measures none.
    """
    node = (pipeline.ref(output) if only else pipeline.outputs[output]).node
    for bound in pipeline.nodes[node].inputs:
        if bound.port.name == "image" and len(bound.refs) == 1:
            return bound.refs[0]
    raise UsageError(f"--keep-presses: node {node!r} measures no port 'image'")


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
