"""The process that runs a variant beside the pipeline in service; no command for people."""

from __future__ import annotations

import os
import sys
import time
from typing import IO, Any

from tactile_graph.engine.calls.isolated_worker import end_with_parent, received, sent

NICE = 19
"""Whoever else works on this machine comes first."""


def serve(orders: IO[bytes], answers: IO[bytes]) -> None:
    """Answer frames with the scalars of each output and the time taken, until no more come."""
    sys.path[:] = received(orders)
    from tactile_graph.live.beside import scalars_of

    pipeline, only, seed = received(orders)
    runner = pipeline.runner(only, seed)
    while True:
        try:
            frame: Any = received(orders)
        except EOFError:
            return
        begun_ns = time.perf_counter_ns()
        result = runner(frame)
        sent(answers, (scalars_of(result), time.perf_counter_ns() - begun_ns))


if __name__ == "__main__":
    if hasattr(os, "nice"):
        os.nice(NICE)
    channel = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what a step prints is for people
    end_with_parent()
    serve(sys.stdin.buffer, channel)
