"""The bench process: frames through the pipeline, pictures of it to the server, commands back."""

from __future__ import annotations

import signal
import time
from multiprocessing.connection import Connection
from typing import Any

from tactile_graph import Pipeline
from tactile_graph_live.bench.snapshot import Photographer

PICTURE_S = 1 / 30


def main(pipe: Connection, pipeline: Pipeline, seed: int) -> None:
    """Run until told to end."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    photographer = Photographer(pipeline, 1)
    runner = pipeline.runner(seed=seed)
    due = 0.0
    index = 0
    while True:
        for frame in pipeline.frames(seed):
            while pipe.poll():
                command, *rest = pipe.recv()
                if command == "show":
                    photographer.shown = rest[0]
                if command == "end":
                    return
            arrived = time.perf_counter()
            result = runner(frame.with_index(index))
            index += 1
            latency_us = (time.perf_counter() - arrived) * 1e6
            if time.monotonic() >= due:
                due = time.monotonic() + PICTURE_S
                pipe.send(photographer.snapshot(result, latency_us))
            time.sleep(0.03)


def ended(pipe: Any) -> bool:
    """Return whether the other side is gone."""
    return bool(pipe.closed)
