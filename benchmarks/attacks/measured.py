"""Run something in a process of its own, and measure its CPU seconds and the memory it takes."""

from __future__ import annotations

import json
import os
import resource
import signal
import time
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

MB = 1e6
KILLED_S = 30
MOST_MEMORY = 6_000_000_000


class Measured(NamedTuple):
    """What came of it, in a word and at length, and what it took."""

    came: str
    why: str
    seconds: float
    megabytes: float


def measured(act: Callable[[], tuple[str, str]]) -> Measured:
    """Return what came of an act in a fork of this process, ended if it takes out of all measure.

    Parameters
    ----------
    act : callable
        Returns what came of it, in a word and at length. What it needs is imported before, so that
        the imports are not counted.
    """
    read, write = os.pipe()
    pid = os.fork()
    if pid == 0:
        os.close(read)
        _child(act, write)
    os.close(write)
    with os.fdopen(read, "rb") as pipe:
        data = pipe.read()
    _, status, used = os.wait4(pid, 0)
    if data:
        return Measured(*json.loads(data))
    came = "OUT OF TIME" if os.WIFSIGNALED(status) else "ENDED"
    return Measured(came, f"status {status}", used.ru_utime + used.ru_stime, used.ru_maxrss / 1e3)


def _child(act: Callable[[], tuple[str, str]], write: int) -> None:
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    os.dup2(nowhere, 2)
    signal.signal(signal.SIGXCPU, signal.SIG_DFL)
    signal.alarm(10 * KILLED_S)
    warnings.simplefilter("ignore")
    resource.setrlimit(resource.RLIMIT_CPU, (KILLED_S, KILLED_S))
    resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY, MOST_MEMORY))
    Path("/proc/self/clear_refs").write_text("5")  # forgets how much the parent ever took
    before, begun = _peak_bytes(), time.process_time()
    try:
        came, why = act()
    except BaseException as error:  # or this process would go on as the other one
        came, why = "FOREIGN", repr(error)
    seconds = time.process_time() - begun
    found = [came, why[:300], seconds, (_peak_bytes() - before) / MB]
    os.write(write, json.dumps(found).encode())
    os._exit(0)


def _peak_bytes() -> int:
    """Return the most memory that this process has held so far."""
    for line in Path("/proc/self/status").read_text().splitlines():
        if line.startswith("VmHWM:"):
            return 1024 * int(line.split()[1])
    raise OSError("the system does not tell how much memory is held")
