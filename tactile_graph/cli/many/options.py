"""``--workers`` and ``--on``, for any command whose work can be shared."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar

import click

if TYPE_CHECKING:
    from tactile_graph.engine.plan import Plan
    from tactile_graph.many.executor_kind import Place

F = TypeVar("F", bound=Callable[..., Any])


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
            type=click.IntRange(min=1),
            metavar="N",
            help="Let N processes share the work; the outcome is the same.",
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
    from tactile_graph.many.executor_kind import place_of

    return place_of(on, workers)


def place_for(workers: int | None, on: str | None, plan: Plan) -> Place | None:
    """Return where workers are asked for, if they can have frames of a plan; else say why not."""
    place = place_asked(workers, on)
    if place is None:
        return None
    from tactile_graph.cli.terminal import console
    from tactile_graph.many.division import one_process_only

    why_not = one_process_only(plan)
    if why_not:
        said = console(stderr=True)
        said.print(f"in one process: {why_not}", style="yellow", soft_wrap=True)
        return None
    return place


def side_by_side(place: Place) -> str:
    """Return what must be said of times that workers took."""
    n = place.n_workers
    how = f"{n} workers" if n is not None else "several workers"
    return f"times were taken with {how} side by side; measure them with one process alone"
