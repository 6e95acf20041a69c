"""``tactile-graph identify``: which known object lies in each frame."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tactile_graph.cli.arguments import Span, open_pipeline, parse_span, source_options
from tactile_graph.cli.endings import SOME_FAILED
from tactile_graph.errors import UsageError
from tactile_graph_classifiers.commands.shared import database_option

if TYPE_CHECKING:
    from tactile_graph.api.pipeline import Pipeline
    from tactile_graph.api.result import Result

HEAD = ("frame", "object", "distance", "runner-up", "margin", "")


@click.command()
@source_options
@database_option
@click.option("--pipeline", default="identify-any", show_default=True,
              help="Which pipeline identifies: a name or a YAML file.")  # fmt: skip
@click.option("--frames", "span", callback=parse_span, metavar="N|A:B",
              help="Only the first N frames, or frames A up to B, counted from 0.")  # fmt: skip
def identify(
    recordings: tuple[str, ...],
    source: str | None,
    source_settings: tuple[str, ...],
    settings: tuple[str, ...],
    seed: int,
    only: tuple[str, ...],
    database: Path,
    timeout_s: float,
    pipeline: str,
    span: Span,
) -> None:
    """Say for each frame of the recordings which known object it is, and which comes next.

    The margin is 0 for a tie of the two and 1 where nothing else comes into question. Programs
    ask 'tactile-graph run identify-any -o -' for lines.
    """
    from tactile_graph.steps.injected import Report
    from tactile_graph_classifiers.database.store import ObjectDatabase

    if not recordings and source is None:
        raise UsageError("name the recordings to identify, or a --source")
    ObjectDatabase(database, timeout_s).summaries()  # what is wrong with it, before the pipeline
    opened = open_pipeline(pipeline, recordings, source, source_settings, settings, span)
    node = _identifying(opened, only)
    opened = opened.with_settings({f"{node}.database": str(database)})
    report = Report()
    runner = opened.runner([node], seed)
    lines = _Lines(node)
    for frame in span.of(opened.frames(seed, report)):
        lines.add(runner(frame))
    for where, what in report.troubles:
        click.echo(f"{where}: {what}", err=True)
    lines.summarise()
    if lines.n_failed:
        click.get_current_context().exit(SOME_FAILED)


def _identifying(pipeline: Pipeline, only: tuple[str, ...]) -> str:
    """Return the node that identifies: it gives an identity and reads a database.

    Raises
    ------
    UsageError
        If there is none, or more than one to choose from.
    """
    from tactile_graph_classifiers.distances.identity import Identity

    found = [
        name
        for name, node in pipeline.nodes.items()
        if node.signature is not None
        and node.output is Identity
        and any(s.name == "database" for s in node.signature.settings)
        and (not only or name in only)
    ]
    if len(found) == 1:
        return found[0]
    what = f"{len(found)} nodes that identify ({', '.join(found)})" if found else "no such node"
    raise UsageError(f"pipeline {pipeline.name!r} has {what}; name one with --only")


class _Lines:
    """A line a frame, and what they came to."""

    def __init__(self, node: str) -> None:
        self.node = node
        self.n_failed = 0
        self.counts: Counter[str] = Counter()
        self.n_true = self.n_right = 0

    def add(self, result: Result) -> None:
        """Write the line of a frame.

        Raises
        ------
        OtherQuantityError
            If it is in another unit than the objects were learned in.
        """
        from tactile_graph.engine.outcome import Failed, Skipped
        from tactile_graph_classifiers.database.known import OtherQuantityError

        outcome: Any = result.outcome(self.node)
        if isinstance(outcome, Failed) and isinstance(outcome.error, OtherQuantityError):
            raise outcome.error  # no other frame of these recordings would fare better
        if not self.counts:
            click.echo(_line(*HEAD))
        if isinstance(outcome, Failed | Skipped):
            kind = "failed" if isinstance(outcome, Failed) else "skipped"
            self.n_failed += kind == "failed"
            self.counts[f"({kind})"] += 1
            click.echo(f"{result.frame.index:>5}  {kind}: {outcome.reason}")
            return
        self.counts[outcome.name] += 1
        second = outcome.runner_up or "-"
        note = self._judged(result, outcome)
        if not outcome.known:
            note = f"nearest: {outcome.nearest}, accepted up to {outcome.limit:.3g} {note}".rstrip()
        number, margin = f"{outcome.distance:.3g}", f"{outcome.margin:.3f}"
        click.echo(_line(str(result.frame.index), outcome.name, number, second, margin, note))

    def _judged(self, result: Result, identity: Any) -> str:
        from tactile_graph_classifiers.measuring.shapes import true_name

        name = true_name(result.frame)
        if not name:
            return ""
        self.n_true += 1
        self.n_right += name == identity.name
        return "" if name == identity.name else f"(truly {name})"

    def summarise(self) -> None:
        """Write what the lines came to.

        Raises
        ------
        UsageError
            If there was no frame.
        """
        if not self.counts:
            raise UsageError("the source gave no frame")
        click.echo(", ".join(f"{name}: {n}" for name, n in self.counts.most_common()))
        if self.n_true:
            click.echo(f"right: {self.n_right} of {self.n_true}")


def _line(number: str, name: str, distance: str, second: str, margin: str, note: str) -> str:
    text = f"{number:>5}  {name:<20}  {distance:>9}  {second:<20}  {margin:>6}  {note}"
    return text.rstrip()
