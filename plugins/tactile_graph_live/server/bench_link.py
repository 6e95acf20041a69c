"""The server's end of the bench: its process, and what goes to and fro."""

from __future__ import annotations

import asyncio
import multiprocessing
import threading
from collections.abc import Callable
from typing import Any

from tactile_graph import Pipeline
from tactile_graph_live.bench.process import main


class BenchLink:
    """A bench process and the pipe to it."""

    def __init__(self, pipeline: Pipeline, seed: int) -> None:
        context = multiprocessing.get_context("spawn")
        self._pipe, theirs = context.Pipe()
        self._process = context.Process(target=main, args=(theirs, pipeline, seed), daemon=True)
        self._process.start()
        theirs.close()

    def start(self, loop: asyncio.AbstractEventLoop, take: Callable[[Any], None]) -> None:
        """Begin to hand on what comes, in the event loop."""

        def read() -> None:
            while True:
                try:
                    came = self._pipe.recv()
                except (EOFError, OSError):
                    return
                loop.call_soon_threadsafe(take, came)

        threading.Thread(target=read, daemon=True).start()

    def send(self, *command: Any) -> None:
        """Tell the bench something."""
        self._pipe.send(command)

    def close(self) -> None:
        """End it."""
        self.send("end")
        self._process.join(5)
