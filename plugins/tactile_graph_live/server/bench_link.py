"""The server's end of the bench: its process, and what goes to and fro."""

from __future__ import annotations

import multiprocessing
import sys
import threading
from collections.abc import Callable
from multiprocessing import resource_tracker
from multiprocessing.connection import Connection
from queue import SimpleQueue

from tactile_graph.out_of_reach import out_of_reach, safe_path
from tactile_graph_live.bench.process import ENDS, main
from tactile_graph_live.bench.wire import End, FromBench, Order, ToBench

PATIENCE_S = 5.0


class BenchLink:
    """A bench process and the pipe to it; sending never waits, and what comes is handed on.

    Parameters
    ----------
    order : Order
    take : callable
        Given whatever the bench sends, in a thread of this link's own.
    gone : callable
        Called in that thread when the process is gone without having been told to end.
    """

    def __init__(
        self, order: Order, take: Callable[[FromBench], None], gone: Callable[[], None]
    ) -> None:
        context = multiprocessing.get_context("spawn")
        self._pipe, theirs = context.Pipe()
        self._process = context.Process(
            target=main, args=(theirs, order), name="tactile-graph bench", daemon=True
        )
        with safe_path():
            if sys.platform != "win32":  # or it would be begun below, and unblock the signals
                resource_tracker.ensure_running()
            with out_of_reach(*ENDS):
                self._process.start()
        theirs.close()
        self._take, self._gone = take, gone
        self._ending = False
        self._queue: SimpleQueue[ToBench | None] = SimpleQueue()
        self._threads = [
            threading.Thread(target=work, args=(self._pipe,), daemon=True)
            for work in (self._read, self._write)
        ]
        for thread in self._threads:
            thread.start()

    @property
    def pid(self) -> int | None:
        """Number of the process."""
        return self._process.pid

    def send(self, message: ToBench) -> None:
        """Tell the bench something."""
        self._queue.put(message)

    def close(self) -> None:
        """End the bench, and wait for it: by force, if it takes too long."""
        self._ending = True
        self._queue.put(End())
        self._queue.put(None)
        self._process.join(PATIENCE_S)
        if self._process.is_alive():
            self._process.kill()
            self._process.join()
        for thread in self._threads:
            thread.join(PATIENCE_S)
        self._pipe.close()

    def _read(self, pipe: Connection) -> None:
        while True:
            try:
                came = pipe.recv()
            except (EOFError, OSError):
                break
            self._take(came)
        self._queue.put(None)
        if not self._ending:
            self._gone()

    def _write(self, pipe: Connection) -> None:
        while (message := self._queue.get()) is not None:
            try:
                pipe.send(message)
            except OSError:
                return
