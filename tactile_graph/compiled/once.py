"""What a process makes once, machine code and imports, told apart from what it does each time."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import TypeVar

from tactile_graph.compiled.preparing import preparing

MOST_RUNS = 3
R = TypeVar("R")


def made_so_far() -> int:
    """Return a number that is another one once this process made or loaded something more.

    Machine code of any function, and modules; what another process makes is not seen.
    """
    return preparing.n_made + len(sys.modules)


def once_made(run: Callable[[], R]) -> R:
    """Return what a run gives for which nothing had to be made, so that its time is its own.

    Parameters
    ----------
    run : callable
        Gives the same again; it is run at most three times.
    """
    for _ in range(MOST_RUNS - 1):
        before = made_so_far()
        answer = run()
        if made_so_far() == before:
            return answer
    return run()
