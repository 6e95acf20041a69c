"""``tactile-graph explain``: one frame's story, node by node."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from tactile_graph.cli.arguments import open_pipeline, pipeline_argument, source_options
from tactile_graph.cli.endings import SOME_FAILED
from tactile_graph.errors import UsageError
from tactile_graph.steps.injected import Report

if TYPE_CHECKING:
    from tactile_graph.api.pipeline import Pipeline
    from tactile_graph.api.result import Result


@click.command(epilog="Exit codes: 0 no output failed, 1 some did, 2 not done.")
@pipeline_argument
@source_options
@click.option("--frame", "number", type=click.IntRange(min=0), default=0, show_default=True,
              metavar="N", help="Which frame of the source, counted from 0.")  # fmt: skip
def explain(
    pipeline: str | None,
    recordings: tuple[str, ...],
    source: str | None,
    source_settings: tuple[str, ...],
    settings: tuple[str, ...],
    seed: int,
    only: tuple[str, ...],
    number: int,
) -> None:
    """Say for one frame of PIPELINE what each node did: ran, was skipped, failed, why, how long.

    Times are those of a first frame: what is done once, and caches, included.
    """
    from tactile_graph.cli.arguments import Span
    from tactile_graph.cli.terminal import console
    from tactile_graph.compiled import answered_meanwhile
    from tactile_graph.draw.tables import result_table
    from tactile_graph.engine.outcomes.outcome import Failed

    span = Span(0, number + 1)
    opened = open_pipeline(pipeline, recordings, source, source_settings, settings, span)
    with answered_meanwhile() as meanwhile:
        result = _result(opened, only, seed, number)
    out = console()
    out.print(_heading(result))
    out.print(result_table(result))
    told = "times are of a first frame: what is made, read or compiled once is in them"
    if meanwhile is not None and meanwhile.under_way is not None:
        told += "; slower plain code answered for kernels that are not compiled yet"
    out.print(told, style="dim", soft_wrap=True)
    for node, text in result.notices.items():
        out.print(f"notice  {node}: {text}", style="yellow", soft_wrap=True)
    if any(isinstance(result.outcome(name), Failed) for name in result.plan.asked):
        click.get_current_context().exit(SOME_FAILED)


def _result(pipeline: Pipeline, only: tuple[str, ...], seed: int, number: int) -> Result:
    """Return the frame's result; steps that keep state see the frames before it, others do not."""
    runner = pipeline.runner(only, seed)
    n = 0
    frames = pipeline.frames(seed, Report())
    for frame in frames:
        if n == number:
            result = runner(frame)
            pipeline.promises.check(result)
            return result
        if runner.stateful:
            runner(frame)
        n += 1
    raise UsageError(f"--frame {number}: the source gave {n} frames, the first is 0")


def _heading(result: Result) -> Any:
    from rich.text import Text

    frame = result.frame
    pipeline = result.plan.pipeline
    image = frame.image
    text = Text.assemble((pipeline.name, "bold"), f", frame {frame.index}")
    text.append(f" of {pipeline.source.name}" if pipeline.source else "")
    text.append(f": {image.rows} x {image.columns} {image.quantity}, ")
    text.append(f"total {image.total:.4g}, peak {image.peak:.4g}")
    if frame.truth:
        kinds = ", ".join(t.name or type(t.shape).__name__ for t in frame.truth)
        text.append(f"; truly there: {kinds}")
    return text
