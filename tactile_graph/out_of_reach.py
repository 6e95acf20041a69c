"""Processes that a signal to the whole group does not end, and no file beside them leads astray."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from threading import Lock

_SAFE_PATH, _OURS = "PYTHONSAFEPATH", "tactile-graph"
_beginning = Lock()


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


@contextmanager
def safe_path() -> Iterator[None]:
    """Have processes that multiprocessing begins within the block import nothing lying beside them.

    It begins them by ``python -c``, which looks into the current folder first: a ``pickle.py``
    that came with a recording would run. Where this process imports from it tells them itself,
    before anything of its own is imported there. They call `end_safe_path` when they run.
    """
    with _beginning:
        if os.environ.get(_SAFE_PATH):
            yield
            return
        os.environ[_SAFE_PATH] = _OURS
        try:
            yield
        finally:
            end_safe_path()


def end_safe_path() -> None:
    """Let what this process begins import as ever, such as a script what lies beside it."""
    if os.environ.get(_SAFE_PATH) == _OURS:
        del os.environ[_SAFE_PATH]
