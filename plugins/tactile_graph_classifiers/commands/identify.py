"""``tactile-graph identify``: which known object lies in each frame."""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tactile_graph.cli.arguments import Span, open_pipeline, parse_span, source_options
from tactile_graph.cli.endings import SOME_FAILED
from tactile_graph.cli.say import say
from tactile_graph.errors import UsageError
from tactile_graph_classifiers.commands.shared import database_option, tell_assumed_pad

if TYPE_CHECKING:
    from tactile_graph.api.pipeline import Pipeline
    from tactile_graph.api.result import Result
    from tactile_graph_classifiers.database.instrument import Instrument
    from tactile_graph_classifiers.distances.identity import Identity
    from tactile_graph_classifiers.measuring.measurements import Measurements

HEAD = ("object", "distance", "runner-up", "margin", "")


@click.command()
@source_options
@database_option
@click.option("--pipeline", default="identify-any", show_default=True,
              help="Which pipeline identifies: a name or a YAML file.")  # fmt: skip
@click.option("--frames", "span", callback=parse_span, metavar="N|A:B",
              help="Only the first N frames, or frames A up to B, counted from 0.")  # fmt: skip
@click.option("--together", type=click.Choice(("recording", "all")),
              help="The frames of each recording, or of all, are presses of one object: name it"
                   " once, by all of them.")  # fmt: skip
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
    together: str | None,
) -> None:
    """Say for each frame of the recordings which known object it is, and which comes next.

    The margin is 0 for a tie of the two and 1 where nothing else comes into question. Several
    presses of an object, named --together, tell what one does not: strangers above all. Programs
    ask 'tactile-graph run identify-any -o -' for lines.
    """
    from tactile_graph.api.pipeline import load
    from tactile_graph.compiled import answered_meanwhile
    from tactile_graph.steps.injected import Report
    from tactile_graph_classifiers.database.store import ObjectDatabase
    from tactile_graph_classifiers.measuring.reader import instrument_of, is_by_law

    if not recordings and source is None:
        raise UsageError("name the recordings to identify, or a --source")
    known = ObjectDatabase(database, timeout_s).known()  # what is wrong with it comes first
    node = _identifying(load(pipeline), only)
    # With the source and not after it: what the sample knows may be in another unit than both.
    settings = (*settings, f"{node}.database={json.dumps(str(database), ensure_ascii=False)}")
    opened = open_pipeline(pipeline, recordings, source, source_settings, settings, span)
    report = Report()
    runner = opened.runner([node], seed)
    several = len(recordings) > 1
    lines = _Together(opened, node, together) if together else _Lines(node, several)
    other: Instrument | None = None
    by_law = False
    with answered_meanwhile():
        for frame in span.of(opened.frames(seed, report)):
            lines.add(runner(frame))
            by_law |= is_by_law(frame, known.quantity)
            instrument = instrument_of(frame)
            if known.instrument is not None and not instrument.same_as(known.instrument):
                other = instrument
    for line in report.few_troubles():
        say(line, err=True)
    lines.summarise()
    if by_law:
        tell_assumed_pad(opened, settings)
    if other is not None:
        say(f"frames are of {other}, but the objects were learned on {known.instrument}: the"
            " answers may mean nothing; learn them on this instrument, into another database",
            err=True)  # fmt: skip
    if known.few:
        say(
            f"strangers may pass for known, and margins say little: {known.few}; learn more",
            err=True,
        )
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


def _named(result: Result, node: str, several: bool) -> Any:
    """Return the outcome of the node that identifies.

    Raises
    ------
    OtherQuantityError, OtherPadError
        If the frame is in another unit than the objects were learned in, or of another pad than
        the one that their reliefs were learned on: of several recordings each may be of its own.
    """
    from tactile_graph.engine.outcomes.outcome import Failed
    from tactile_graph_classifiers.database.known import OtherPadError, OtherQuantityError

    outcome: Any = result.outcome(node)
    ends = (OtherQuantityError,) if several else (OtherPadError, OtherQuantityError)
    if isinstance(outcome, Failed) and isinstance(outcome.error, ends):
        raise outcome.error  # no other frame of these recordings would fare better
    return outcome


class _Lines:
    """A line a frame, and what they came to."""

    def __init__(self, node: str, several: bool = False) -> None:
        self.node, self.several = node, several
        self.n_failed = 0
        self.counts: Counter[str] = Counter()
        self.n_true = self.n_right = 0

    def add(self, result: Result) -> None:
        """Write the line of a frame.

        Raises
        ------
        OtherQuantityError, OtherPadError
            As `_named`.
        """
        from tactile_graph.engine.outcomes.outcome import Failed, Skipped
        from tactile_graph_classifiers.measuring.shapes import true_name

        outcome = _named(result, self.node, self.several)
        if not self.counts:
            say(f"frame  {_line(*HEAD)}")
        start = f"{result.frame.index:>5}  "
        if isinstance(outcome, Failed | Skipped):
            kind = "failed" if isinstance(outcome, Failed) else "skipped"
            self.n_failed += kind == "failed"
            self.counts[f"({kind})"] += 1
            say(f"{start}{kind}: {outcome.reason}")
            return
        say(start + self.told(outcome, true_name(result.frame)))

    def told(self, identity: Identity, true: str, note: str = "") -> str:
        """Count an answer, and return it as a line."""
        from tactile_graph_classifiers.database.names import plain_name

        self.counts[identity.name] += 1
        if not identity.known:
            why = f"; {identity.note}" if identity.note else ""
            note = f"nearest: {identity.nearest}, accepted up to {identity.limit:.3g}{why} {note}"
        if true:
            self.n_true += 1
            right = plain_name(true) == plain_name(identity.name)
            self.n_right += right
            note += "" if right else f" (truly {true})"
        number, margin = f"{identity.distance:.3g}", f"{identity.margin:.3f}"
        note = " ".join(note.split())
        return _line(identity.name, number, identity.runner_up or "-", margin, note)

    def summarise(self) -> None:
        """Write what the lines came to.

        Raises
        ------
        UsageError
            If there was no frame.
        """
        if not self.counts:
            raise UsageError("the source gave no frame")
        say(", ".join(f"{name}: {n}" for name, n in self.counts.most_common()))
        if self.n_true:
            say(f"right: {self.n_right} of {self.n_true}")


@dataclass
class _Pressed:
    """The presses of a recording so far: what was measured, named alone, and true."""

    presses: list[Measurements] = field(default_factory=list)
    alone: Counter[str] = field(default_factory=Counter)
    true: set[str] = field(default_factory=set)


class _Together(_Lines):
    """A line for each recording, or one for all, in closing."""

    def __init__(self, pipeline: Pipeline, node: str, which: str) -> None:
        super().__init__(node)
        it = pipeline.nodes[node]
        self._step: Any = it.callable
        if not hasattr(self._step, "together"):
            raise UsageError(
                f"--together: step {it.what!r} of node {node!r} names each reading by itself; step"
                " 'discriminant' (pipeline identify-any) names several together"
            )
        self._measured = it.inputs[0].refs[0]
        self._in_all = which == "all"
        self._recordings: dict[str, _Pressed] = {}
        self._left_out: Counter[str] = Counter()

    def add(self, result: Result) -> None:
        """Take a press.

        Raises
        ------
        OtherQuantityError, OtherPadError
            As `_named`.
        """
        from tactile_graph.engine.outcomes.outcome import Failed, Skipped
        from tactile_graph_classifiers.measuring.shapes import true_name

        outcome = _named(result, self.node, self.several)
        if isinstance(outcome, Failed | Skipped):
            self.n_failed += isinstance(outcome, Failed)
            self._left_out[outcome.reason.partition(" (")[0]] += 1
            return
        label = "all" if self._in_all else result.frame.label or "recording"
        of = self._recordings.setdefault(label, _Pressed())
        of.presses.append(result.outcome_at(self._measured))
        of.alone[outcome.nearest] += 1
        of.true.add(true_name(result.frame))

    def summarise(self) -> None:
        """Write a line for each recording, and what they came to.

        Raises
        ------
        UsageError
            If no frame could be named, or the frames of a recording are of several objects.
        """
        for what, n in self._left_out.items():
            say(f"left out: {n} frames: {what}", err=True)
        if not self._recordings:
            raise UsageError("the source gave no frame in which an object could be named")
        width = max(len("recording"), *map(len, self._recordings))
        say(f"{'recording':<{width}}  presses  {_line(*HEAD)}")
        for label, of in self._recordings.items():
            if len(of.true) > 1:
                raise UsageError(
                    f"--together: {label} holds several objects: {', '.join(sorted(of.true))};"
                    " name one object at a time, or frame by frame"
                )
            identity, n = self._step.together(of.presses), len(of.presses)
            most = of.alone[identity.nearest]
            note = f"alone, {most} of {n} presses are nearest to it" if 2 * most < n else ""
            line = self.told(identity, next(iter(of.true)), note)
            say(f"{label:<{width}}  {n:>7}  {line}")
        super().summarise()


def _line(name: str, distance: str, second: str, margin: str, note: str) -> str:
    return f"{name:<20}  {distance:>9}  {second:<20}  {margin:>6}  {note}".rstrip()
