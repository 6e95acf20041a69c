"""What a call leaves changed of the process that it shares with all other steps."""

from __future__ import annotations

import os
import random
import signal
import threading
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any

import numpy as np

OURS = ("SIGALRM", "SIGKILL", "SIGSTOP")
"""Signals that stop what takes too long, or that nobody can handle."""


@contextmanager
def told_in(left: list[str]) -> Iterator[None]:
    """Enter what is changed meanwhile by its name, and put most of it back."""
    before = _shared()
    try:
        yield
    finally:
        now = _shared()
        left += [name for name, state in before.items() if state != now[name]]
        if "the current folder" in left:
            with suppress(OSError):  # it may be gone
                os.chdir(before["the current folder"])
        if "the handlers of signals" in left:
            _handle(before["the handlers of signals"])


def _shared() -> dict[str, Any]:
    kind, keys, *rest = np.random.get_state()  # noqa: NPY002 -- what others may use
    return {
        "the current folder": os.getcwd(),
        "how NumPy tells errors": np.geterr(),
        "whether warnings are errors": [f[0] == "error" for f in warnings.filters[:1]],
        "the handlers of signals": _handlers(),
        "the random numbers of the module random": random.getstate(),
        "the random numbers of numpy.random": (kind, np.asarray(keys).tobytes(), *rest),
    }


def _handlers() -> dict[signal.Signals, Any]:
    return {s: signal.getsignal(s) for s in signal.Signals if s.name not in OURS}


def _handle(before: dict[signal.Signals, Any]) -> None:
    if threading.current_thread() is not threading.main_thread():
        return  # no other may
    for number, handler in before.items():
        if handler is not None and signal.getsignal(number) != handler:
            signal.signal(number, handler)
