"""``out_of_reach``: processes that a signal to the whole group does not end."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def out_of_reach(*numbers: int) -> Iterator[None]:
    """Have processes that are begun within the block get none of these signals.

    A terminal sends Ctrl-C to all processes of a command, and one that is still importing would end
    in a traceback. The signals are blocked while the block lasts, and stay so in what is begun; for
    this process they only wait.

    Parameters
    ----------
    *numbers : int
        Signals; Ctrl-C if none is given.
    """
    if not hasattr(signal, "pthread_sigmask"):  # Windows
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, numbers or {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
