"""``tactile-graph prepare``: machine code made before it is needed."""

from __future__ import annotations

import os
import time
from contextlib import ExitStack
from itertools import islice

import click

from tactile_graph.cli.ahead import FRAMES
from tactile_graph.cli.completions import complete_pipeline
from tactile_graph.errors import UsageError
from tactile_graph.out_of_reach import end_safe_path, safe_path
from tactile_graph.plugins import registry
from tactile_graph.plugins.devices import reads_device

FAILED = "not prepared"


@click.command()
@click.argument("pipelines", metavar="[PIPELINE]...", nargs=-1, shell_complete=complete_pipeline)
@click.option(
    "--jobs",
    type=click.IntRange(min=1),
    default=os.cpu_count() or 1,
    show_default="one for each processor",
    help="Processes that compile at the same time.",
)
def prepare(pipelines: tuple[str, ...], jobs: int) -> None:
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
    out = console()
    if jobs == 1:
        for name in names:
            out.print(prepared(name), soft_wrap=True, highlight=False)
        return
    with ExitStack() as opened:
        with safe_path():
            spawn, given = get_context("spawn"), (registry.selected(),)
            pool = ProcessPoolExecutor(min(jobs, len(names)), spawn, _begin, given)
            opened.enter_context(pool)
            coming = [pool.submit(prepared, name) for name in names]
        for done in as_completed(coming):
            out.print(done.result(), soft_wrap=True, highlight=False)


def _begin(selection: str) -> None:
    end_safe_path()
    registry.restrict(selection)


def prepared(name: str) -> str:
    """Compile what a pipeline's first frames need; return what to say of it."""
    from tactile_graph.api.pipeline import load
    from tactile_graph.compiled import warm_up
    from tactile_graph.compiled.preparing import preparing
    from tactile_graph.errors import TactileGraphError
    from tactile_graph.wires.frame_stack import in_stacks

    start = time.monotonic()
    warm_up()
    try:
        pipeline = load(name)
        if pipeline.source is None:
            return f"{name}: {FAILED}, declares no source"
        if reads_device(pipeline.source.name):
            return f"{name}: {FAILED}, its source reads a device"
        if pipeline.writes:
            return f"{name}: {FAILED}, a step of it writes"
        frames = [*islice(pipeline.frames(), FRAMES)]
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
