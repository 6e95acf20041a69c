"""``tactile-graph prepare``: machine code made before it is needed."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from contextlib import ExitStack
from heapq import nlargest
from itertools import islice
from operator import itemgetter
from typing import TYPE_CHECKING

import click

from tactile_graph.cli.ahead import FRAMES
from tactile_graph.cli.completions import complete_pipeline
from tactile_graph.errors import UsageError
from tactile_graph.out_of_reach import end_safe_path, safe_path
from tactile_graph.plugins import registry
from tactile_graph.plugins.devices import reads_device
from tactile_graph.steps.injected import Report

if TYPE_CHECKING:
    from tactile_graph.api.pipeline import Pipeline
    from tactile_graph.wires.frame import Frame

FAILED = "not prepared"
MOST_LOOKED_AT = 10_000
"""Frames of a recording among which the most loaded ones are looked for."""


@click.command()
@click.argument("pipelines", metavar="[PIPELINE]...", nargs=-1, shell_complete=complete_pipeline)
@click.option(
    "--jobs",
    type=click.IntRange(min=1),
    default=os.cpu_count() or 1,
    show_default="one for each processor",
    help="Processes that compile at the same time.",
)
@click.option(
    "--recording",
    metavar="FILE",
    type=click.Path(),
    help="Run frames of this recording, the first and the most loaded ones, instead of each "
    "pipeline's own: wide contacts on large pads need machine code of their own.",
)
def prepare(pipelines: tuple[str, ...], jobs: int, recording: str | None) -> None:
    """Compile the kernels of pipelines now; without any named, of all installed.

    Runs the first frames of each pipeline's own source, and keeps the machine code on disk. What
    is there already is not compiled again. A pipeline without a source, with one that reads a
    device, or with a step that writes, is left out.
    """
    from concurrent.futures import ProcessPoolExecutor, as_completed
    from multiprocessing import get_context

    from tactile_graph.api.pipeline import load
    from tactile_graph.cli.terminal import console

    names = pipelines or tuple(registry.installed().names("pipelines"))
    if not names:
        raise UsageError("name a pipeline or a file of one: no plugin offers any")
    for name in pipelines:
        load(name)
    if recording is not None:
        if not pipelines:
            raise UsageError("name the pipelines that are prepared by --recording")
        next(_reading(load(pipelines[0]), recording).frames(report=Report()), None)
    out = console()
    if jobs == 1:
        for name in names:
            out.print(prepared(name, recording), soft_wrap=True, highlight=False)
        return
    with ExitStack() as opened:
        with safe_path():
            spawn, given = get_context("spawn"), (registry.selected(),)
            pool = ProcessPoolExecutor(min(jobs, len(names)), spawn, _begin, given)
            opened.enter_context(pool)
            coming = [pool.submit(prepared, name, recording) for name in names]
        for done in as_completed(coming):
            out.print(done.result(), soft_wrap=True, highlight=False)


def _begin(selection: str) -> None:
    end_safe_path()
    registry.restrict(selection)


def prepared(name: str, recording: str | None = None) -> str:
    """Compile what a pipeline's first frames need, or a recording's; return what to say of it."""
    from tactile_graph.api.pipeline import load
    from tactile_graph.compiled import warm_up
    from tactile_graph.compiled.preparing import preparing
    from tactile_graph.errors import TactileGraphError
    from tactile_graph.wires.frame_stack import in_stacks

    start = time.monotonic()
    warm_up()
    try:
        pipeline = load(name)
        if recording is not None:
            pipeline = _reading(pipeline, recording)
        if pipeline.source is None:
            return f"{name}: {FAILED}, declares no source"
        if reads_device(pipeline.source.name):
            return f"{name}: {FAILED}, its source reads a device"
        if pipeline.writes:
            return f"{name}: {FAILED}, a step of it writes"
        frames = _telling(pipeline.frames(), 0 if recording is None else MOST_LOOKED_AT)
        n = sum(1 for _ in pipeline.stream(frames))
        runner = pipeline.runner()
        for stack in in_stacks(frames) if runner.in_blocks else ():
            runner.block(stack)
        runner.prepare()
    except TactileGraphError as error:
        return f"{name}: {FAILED}, {error}"
    if preparing.not_kept:
        return f"{name}: {FAILED}, {preparing.not_kept}"
    return f"{name}: prepared by {n} frames in {time.monotonic() - start:.1f} s"


def _reading(pipeline: Pipeline, recording: str) -> Pipeline:
    from tactile_graph.cli.arguments import Span, source_named

    source = source_named(pipeline, [recording], None, (), Span())
    return pipeline if source is None else pipeline.with_source(source[0], **source[1])


def _telling(frames: Iterator[Frame], n: int) -> list[Frame]:
    """Return the first frames, and of so many that follow the most loaded ones, in their order."""
    import numpy as np

    def load(numbered: tuple[int, Frame]) -> float:
        return float(np.nansum(numbered[1].image.filled(0.0)))

    first = [*islice(frames, FRAMES)]
    most = nlargest(FRAMES, enumerate(islice(frames, n)), key=load)
    return first + [frame for _, frame in sorted(most, key=itemgetter(0))]
