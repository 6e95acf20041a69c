"""Independent parts of a benchmark by several processes, what they come to in order.

What comes out is what one process gives, but for times, which are taken side by side: measure times
with one worker.
"""

from __future__ import annotations

import argparse
import multiprocessing
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from typing import TypeVar

from tactile_graph.compiled import warm_up

Item = TypeVar("Item")
Came = TypeVar("Came")


def add_workers(parser: argparse.ArgumentParser) -> None:
    """Let a benchmark's command take ``--workers``."""
    parser.add_argument(
        "--workers", type=int, default=1, metavar="N", help="processes (times: measure with one)"
    )


def in_order(work: Callable[[Item], Came], items: Iterable[Item], n_workers: int) -> Iterator[Came]:
    """Yield what each item comes to, in order, by machine code from the first call on.

    Parameters
    ----------
    work : callable
        A function of a module, or a `functools.partial` of one.
    items : iterable
        Together with what comes of them they are pickled, where there are several workers.
    n_workers : int
        One: this process itself, each item when it is asked for.
    """
    warm_up()
    if n_workers == 1:
        yield from map(work, items)
        return
    context = multiprocessing.get_context("spawn")  # compiled code survives no fork of threads
    with ProcessPoolExecutor(n_workers, context, initializer=warm_up) as pool:
        yield from pool.map(work, items)
