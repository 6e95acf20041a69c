"""Open a source: its settings filled in, its randomness seeded, its frames watched."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from tactile_graph.errors import DataError
from tactile_graph.steps.injected import Report
from tactile_graph.steps.signature import Signature
from tactile_graph.wires.frame import Frame


def open_source(
    signature: Signature, settings: Mapping[str, Any], seed: int, report: Report
) -> Iterator[Frame]:
    """Yield the frames of a source step.

    Parameters
    ----------
    signature : Signature
        Of the source step.
    settings : mapping
        Validated settings.
    seed : int
        Seeds the source's generator, if it takes one.
    report : Report
        Receives the source's counters and troubles.

    Raises
    ------
    DataError
        If the source yields something that is no frame.
    """
    injected: dict[str, Any] = {}
    if signature.rng:
        injected[signature.rng] = np.random.default_rng(seed)
    if signature.report:
        injected[signature.report] = report
    frames = signature.target(**signature.arguments(settings), **injected)
    try:
        for frame in frames:
            if not isinstance(frame, Frame):
                raise DataError(
                    f"source {signature.name!r}",
                    f"it must yield frames, got {type(frame).__name__}",
                )
            report.counts["frames"] += 1
            yield frame
    finally:
        frames.close()
