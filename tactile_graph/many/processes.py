"""The executor ``processes``: workers on this machine, that end with the process they are of."""

from __future__ import annotations

import multiprocessing
import os
import shutil
import signal
import sys
import tempfile
import threading
from multiprocessing.connection import Connection
from multiprocessing.context import BaseContext

from tactile_graph.errors import UsageError
from tactile_graph.forkserver import begin_forkserver
from tactile_graph.many.executor_kind import ExecutorKind, Opened
from tactile_graph.many.worker_processes import DeadWorkerError, WorkerProcesses
from tactile_graph.plugins.registry import restrict, selected

MOST_PER_CORE = 4
"""Processes: more, of steps that mostly wait too, only take memory and starting."""


def usable_cores() -> int:
    """Return how many cores this process may use."""
    if hasattr(os, "sched_getaffinity"):  # not on macOS and Windows
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def most_workers() -> int:
    """Return how many processes are started at most, however many were asked for."""
    return MOST_PER_CORE * usable_cores()


_scratch: list[str] = []
"""The folder that this worker shares with the others of its run; of another process there is none.
"""


def scratch_folder() -> str | None:
    """Return where a worker puts what its run alone needs; None if it is no worker.

    Who began the workers removes it, and what workers that were killed have left in it.
    """
    return _scratch[0] if _scratch and os.path.isdir(_scratch[0]) else None


def opened(address: str, n_workers: int | None) -> Opened:
    """Return so many processes, at most `most_workers`; one for each core if nobody said how many.

    Raises
    ------
    UsageError
        If an address is given: they are here.
    """
    if address:
        raise UsageError(f"--on processes={address}: processes are on this machine; no address")
    n = min(n_workers or usable_cores(), most_workers())
    folder = tempfile.TemporaryDirectory(prefix="tactile-graph-", ignore_cleanup_errors=True)
    workers = WorkerProcesses(n, _context(), _begin, (selected(), folder.name))

    def end() -> None:
        workers.kill()
        folder.cleanup()

    return Opened(workers, n, end, (DeadWorkerError,))


def _context() -> BaseContext:
    if "forkserver" not in multiprocessing.get_all_start_methods():
        return multiprocessing.get_context("spawn")
    begin_forkserver()  # unless the command line has begun it already
    return multiprocessing.get_context("forkserver")


def _begin(lifeline: Connection, selection: str, folder: str) -> None:
    """Get a worker ready: it is ended by its lifeline, not by Ctrl-C, and prints to stderr."""
    _scratch[:] = [folder]
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    threading.Thread(target=_end_with, args=(lifeline,), daemon=True).start()
    if sys.stderr is not None:
        os.dup2(2, 1)  # stdout may be kept for programs
    restrict(selection)


def _end_with(lifeline: Connection) -> None:
    try:
        lifeline.recv_bytes()
    except (EOFError, OSError):
        if _scratch:  # who began this one was perhaps killed
            shutil.rmtree(_scratch[0], ignore_errors=True)
        os._exit(1)


PROCESSES = ExecutorKind("local processes", opened)
