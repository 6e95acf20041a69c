"""Open a source: its settings filled in, its randomness seeded, its frames watched."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from tactile_graph.engine.outcome import raised_at
from tactile_graph.errors import DataError, TactileGraphError, text_of
from tactile_graph.pipeline.graph import Source
from tactile_graph.steps.injected import Report
from tactile_graph.wires.frame import Frame


def open_source(source: Source, seed: int, report: Report) -> Iterator[Frame]:
    """Yield the frames of a source.

    Parameters
    ----------
    source : Source
        The step and its validated settings.
    seed : int
        Seeds the source's generator, if it takes one.
    report : Report
        Receives the source's counters and troubles.

    Raises
    ------
    DataError
        If the source yields something that is no frame, or raises what nobody wrote for people:
        which source, what, and where in its code.
    """
    try:
        yield from _frames(source, seed, report)
    except TactileGraphError:
        raise
    except (Exception, SystemExit) as error:  # a source may raise anything
        if isinstance(error, OSError) and error.filename is not None:
            raise  # it names the file
        text = f"{type(error).__name__}: {text_of(error)}".removesuffix(": ")
        raise DataError(f"source {source.name!r}", f"{text} ({raised_at(error)})") from error


def _frames(source: Source, seed: int, report: Report) -> Iterator[Frame]:
    signature = source.signature
    injected: dict[str, Any] = {}
    if signature.rng:
        injected[signature.rng] = np.random.default_rng(seed)
    if signature.report:
        injected[signature.report] = report
    frames = signature.target(**signature.arguments(source.settings), **injected)
    try:
        for frame in frames:
            if not isinstance(frame, Frame):
                raise DataError(
                    f"source {source.name!r}",
                    f"it must yield frames, got {type(frame).__name__}",
                )
            report.counts["frames"] += 1
            yield frame
    finally:
        frames.close()
