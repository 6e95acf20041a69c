"""The executor ``dask``: the workers of a cluster, wherever they are, behind its scheduler."""

from __future__ import annotations

import logging
from concurrent.futures import BrokenExecutor
from typing import Any
from urllib.parse import urlsplit

from tactile_graph.errors import UsageError, without
from tactile_graph.many.executor_kind import ExecutorKind, Opened

PATIENCE_S = 5
MISSING = 'a Dask cluster needs Dask: pip install "tactile-graph[cluster]"'


def opened(address: str, n_workers: int | None) -> Opened:
    """Return the executor of the cluster whose scheduler is at an address.

    Raises
    ------
    UsageError
        If Dask is not installed, no address is given, or nobody answers there.
    """
    if not address:
        raise UsageError("--on dask: give the scheduler's address: --on tcp://host:8786")
    try:
        from distributed import Client
        from distributed.scheduler import KilledWorker
    except ImportError as error:
        raise UsageError(without("distributed", error, MISSING)) from error
    connected: Any = Client  # which is not annotated
    logging.getLogger("distributed.client").setLevel(logging.CRITICAL)  # we say it in a line
    try:
        _ = urlsplit(address).port  # a client that is given none that is one cannot be closed
        client = connected(address, timeout=PATIENCE_S, set_as_default=False)
    except (OSError, ValueError, TimeoutError) as error:
        raise UsageError(f"--on {address}: no scheduler answers there: {error}") from error
    # Not pure: what a call comes to is not kept for others, and a second one is done again.
    executor = client.get_executor(pure=False)
    there = sum(client.nthreads().values()) or 1

    def end() -> None:
        executor.shutdown(wait=False)  # it cancels what is under way
        client.close(timeout=PATIENCE_S)

    n = there if n_workers is None else min(n_workers, there)
    return Opened(executor, n, end, (BrokenExecutor, KilledWorker), lambda: len(client.nthreads()))


DASK = ExecutorKind("a Dask cluster", opened, ("tcp", "tls", "ucx", "ws", "wss"))
