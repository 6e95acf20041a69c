"""What tests have workers do: workers import it by name, which they cannot a module of tests."""

from __future__ import annotations

import os
import pickle
import signal
import sys
import tempfile
import threading
import time
from multiprocessing.connection import Connection
from typing import Any

from tactile_graph.many.processes import scratch_folder

LONG = 300_000_000
"""Bytes of an answer that takes a while to send."""


def nothing(lifeline: Connection) -> None:
    pass


def own_process(_: object = None) -> int:
    return os.getpid()


def slowly(seconds: float) -> int:
    time.sleep(seconds)
    return os.getpid()


def killed_while_it_answers() -> bytes:
    """Return a long answer, and die while it is sent."""
    answering = threading.get_ident()

    def kill() -> None:
        while sys._current_frames()[answering].f_code.co_name != "_send":
            time.sleep(0.001)
        os.kill(os.getpid(), signal.SIGKILL)

    threading.Thread(target=kill, daemon=True).start()
    return bytes(LONG)


def die() -> None:
    os._exit(3)


def failed(value: int) -> int:
    raise ValueError(f"{value} is none")


class Sealed:
    def __reduce__(self) -> Any:
        raise pickle.PicklingError("sealed")


def sealed() -> Sealed:
    return Sealed()


class Unreadable(Exception):  # noqa: N818
    def __init__(self, one: int, two: int) -> None:
        super().__init__(one)


def unreadable() -> None:
    raise Unreadable(1, 2)


def leaves_a_folder(seconds: float) -> None:
    """Make a folder for what the run needs, and take long."""
    tempfile.mkdtemp(dir=scratch_folder())
    time.sleep(seconds)
