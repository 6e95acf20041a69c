"""``--workers`` and ``--on``, for any command whose work can be shared."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

import click

if TYPE_CHECKING:
    from tactile_graph.api.pipeline import Pipeline
    from tactile_graph.cli.arguments import Span
    from tactile_graph.engine.plan import Plan
    from tactile_graph.many import Place, Reading, Sharing
    from tactile_graph.many.division import Division
    from tactile_graph.steps.injected import Report
    from tactile_graph.steps.ranges import Ranges
    from tactile_graph.wires.frame import Frame

BY_RECORDING = "each recording by one worker: state starts anew with each"
F = TypeVar("F", bound=Callable[..., Any])
T = TypeVar("T")


def workers_options(command: F) -> F:
    """Add ``--workers`` and ``--on``."""
    for add in (
        click.option(
            "--on",
            metavar="ADDRESS",
            help="Where the workers are: a Dask cluster's scheduler (tcp://host:8786), or an "
            "executor that a plugin offers, NAME or NAME=ADDRESS.",
        ),
        click.option(
            "--workers",
            type=Workers(),
            metavar="N|auto",
            help="Let N processes share the work (auto: one for each core); the outcome is the "
            "same.",
        ),
    ):
        command = add(command)
    return command


def place_asked(workers: int | None, on: str | None) -> Place | None:
    """Return where workers are asked for; None where they are not.

    Raises
    ------
    UsageError
        If nobody offers such a place.
    """
    if workers is None and on is None:
        return None
    from tactile_graph.many.executor_kind import USUAL, place_of
    from tactile_graph.many.processes import MOST_PER_CORE, most_workers

    most = most_workers()
    if workers is not None and workers > most and on in (None, USUAL):
        from tactile_graph.cli.terminal import remark

        remark(f"--workers {workers}: {most} are started, {MOST_PER_CORE} for each core there is")
    return place_of(on, workers)


def place_for(workers: int | None, on: str | None, plan: Plan) -> Place | None:
    """Return where workers are asked for, if they can have frames of a plan; else say why not."""
    place = place_asked(workers, on)
    if place is None:
        return None
    from tactile_graph.many.division import one_process_only

    why_not = one_process_only(plan)
    if why_not:
        say_in_one_process(why_not)
        return None
    return place


def say_in_one_process(why: object) -> None:
    """Tell people why workers are asked for in vain."""
    from tactile_graph.cli.terminal import remark

    remark(f"in one process: {why}")


class Workers(click.ParamType):  # type: ignore[type-arg,unused-ignore]  # generic from click 8.4 on
    """A number of workers, or ``auto``: one for each core that this process may use."""

    name = "number"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> int:
        """Return the number."""
        from tactile_graph.many.processes import usable_cores

        if value == "auto":
            return usable_cores()
        if not re.fullmatch(r"[0-9]+", str(value)) or int(value) < 1:
            self.fail(f"{value!r}: must be a whole number from 1 on, or auto", param, ctx)
        return int(value)


class Sourced(NamedTuple):
    """Where a command's frames come from.

    Attributes
    ----------
    pipeline : Pipeline
        Whose source gives them.
    seed : int
    report : Report
        Takes what is to be said of them.
    span : Span
    """

    pipeline: Pipeline
    seed: int
    report: Report
    span: Span


class Shared(NamedTuple):
    """Who has the frames of a command, and how they are divided.

    Attributes
    ----------
    place : Place
    division : Division
    ranges : Ranges, optional
        By which workers read frames themselves whose state hangs on those before; else they are
        sent.
    """

    place: Place
    division: Division
    ranges: Ranges | None = None

    @property
    def in_place(self) -> bool:
        """Whether workers read the frames themselves."""
        return self.ranges is not None

    def reading(self, pipeline: Pipeline, start: int) -> Reading | None:
        """Return how workers read the frames from a place on; None if they are sent."""
        from tactile_graph.many import Reading

        if self.ranges is None or pipeline.source is None:
            return None
        return Reading.of(pipeline.source, self.division, start)

    def parts(
        self,
        workers: Sharing[T],
        given: Sourced,
        sent: Callable[[], Iterator[Frame]],
        n_before: int,
    ) -> Iterator[T]:
        """Yield what the workers make of each portion.

        Parameters
        ----------
        workers : Sharing
        given : Sourced
            By which workers read the frames themselves.
        sent : callable
            Returns the frames where they are sent instead.
        n_before : int
            How many of those before a portion are sent with it.

        Raises
        ------
        Irregular
            If workers cannot read them: everything is to be done again, by one process.
        """
        if not self.in_place:
            return workers.over_frames(sent(), n_before)
        from tactile_graph.many import Feed

        ends = (given.span.start, given.span.stop)
        feed = Feed(
            given.pipeline, given.seed, given.report, ends, self.division, self.ranges, is_led=True
        )
        feed.look_through()
        return workers.over_feed(feed)


def shared_for(
    workers: int | None, on: str | None, plan: Plan, pipeline: Pipeline, start: int
) -> Shared | None:
    """Return where workers are asked for, and how they have frames of a plan; else say why not.

    Parameters
    ----------
    workers, on
        As they were given.
    plan : Plan
        What is run.
    pipeline : Pipeline
        Whose source gives the frames.
    start : int
        The first of them that is asked for.
    """
    place = place_asked(workers, on)
    if place is None:
        return None
    from tactile_graph.cli.terminal import remark
    from tactile_graph.many.division import division_of, led_to
    from tactile_graph.many.feed import ranges_of

    ranges = ranges_of(pipeline.source) if plan.stateful else None
    division = led_to(start, division_of(plan, ranges))
    if division.why_not:
        say_in_one_process(division.why_not)
        return None
    if division.by_recording:
        remark(BY_RECORDING)
    return Shared(place, division, ranges)


def side_by_side(place: Place) -> str:
    """Return what must be said of times that workers took."""
    from tactile_graph.many.processes import PROCESSES, most_workers

    n = place.n_workers
    if n is not None and place.kind is PROCESSES:
        n = min(n, most_workers())
    how = f"{n} workers" if n is not None else "several workers"
    return f"times were taken with {how} side by side; measure them with one process alone"
