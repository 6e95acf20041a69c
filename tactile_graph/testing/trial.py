"""One call of a step: what it came to, within a bound of time."""

from __future__ import annotations

import signal
import threading
import time
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from types import FrameType
from typing import Any

import numpy as np

from tactile_graph.engine.operations.freeze import freeze
from tactile_graph.errors import TactileGraphError, text_of
from tactile_graph.shared_process import righted
from tactile_graph.testing.left_behind import told_in

FIRST_S = 60.0
"""How long an ordinary frame may take."""
LEAST_S = 5.0
"""No step takes too long that takes less."""
TIMES = 30.0
"""How many times the time of an ordinary frame any other of its size may take."""
IDLE = 10.0
"""How many times its seconds of the processor a step may take by the clock: the rest is others'."""
TOLD_S = 1.0
"""Seconds by the clock from which on they are told: below, a busy machine may take them."""
WAITS_S = 20.0
"""How long a step may wait by the clock while it takes less than its share of the processor."""
LONGEST_LINE = 400


class _TooLong(BaseException):
    """Raised within a step, which must not take it for an error of its own."""


@dataclass(frozen=True)
class Trial:
    """What a call came to: a value, or an error, and how long it took.

    Parameters
    ----------
    value : object
        None where there is none.
    error : Exception, optional
        What the step raised, with its place.
    where : str
        File and line it was raised at.
    seconds, clock_s : float
        Of the processor, and by the clock.
    late : bool
        Whether it was stopped because it took too long.
    left : tuple of str
        What it left changed of the process that all steps share, by its name.
    """

    value: Any = None
    error: BaseException | None = None
    where: str = ""
    seconds: float = 0.0
    late: bool = False
    clock_s: float = 0.0
    left: tuple[str, ...] = ()

    @property
    def answered(self) -> bool:
        """Whether it gave a value."""
        return self.error is None and not self.late

    def trouble(self) -> str:
        """Return what is wrong with how the call ended, in words; "" where nothing is."""
        if self.late:
            long = self.clock_s > max(2.0 * self.seconds, TOLD_S)
            waited = f", {self.clock_s:.0f} s by the clock" if long else ""
            return f"was stopped after {self.seconds:.1f} s of the processor{waited}"
        if self.error is None:
            return ""
        text = text_of(self.error)
        if not isinstance(self.error, TactileGraphError):
            name = type(self.error).__name__
            told = f"{name}: {_line(text)}" if text else name
            return f"raises {told} ({self.where}); raise Degenerate or Skip with the reason"
        name = type(self.error).__name__
        if not text.strip():
            return f"raises {name} without a reason ({self.where})"
        if "\n" in text or len(text) > LONGEST_LINE:
            return f"raises {name} with more than one clear line ({self.where})"
        return ""


def _line(text: str) -> str:
    line = " ".join(text.split())
    return line if len(line) <= 120 else line[:117] + "..."


def attempt(
    call: Callable[..., Any], arguments: dict[str, Any], limit_s: float, package: str = ""
) -> Trial:
    """Return what a call comes to.

    Parameters
    ----------
    call : callable
    arguments : dict
    limit_s : float
        After so many seconds of the processor, `IDLE` times as many by the clock, or `WAITS_S` in
        which it only waits, it is stopped, on the main thread of systems with alarms; elsewhere it
        is only told.
    package : str
        Whose lines errors are told by, rather than those of what it calls.
    """
    left: list[str] = []
    start, start_s = time.process_time(), time.perf_counter()
    try:
        with warnings.catch_warnings(), np.errstate(all="ignore"), _limited(limit_s):
            warnings.simplefilter("ignore")
            with righted(), told_in(left):  # a copy that the step forks is tried no further
                start = time.process_time()
                value = freeze(call(**arguments))
    except _TooLong:
        spent, clock_s = time.process_time() - start, time.perf_counter() - start_s
        return Trial(seconds=spent, late=True, clock_s=clock_s)
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # SystemExit and whatever else a step may raise
        spent = time.process_time() - start
        where = _place(error, package)
        return Trial(None, error.with_traceback(None), where, spent, left=tuple(left))
    spent = time.process_time() - start
    return Trial(value, seconds=spent, late=spent > limit_s, left=tuple(left))


def _place(error: BaseException, package: str) -> str:
    """Return ``module:line`` of the innermost line of a package that an error came through."""
    place, traceback = "", error.__traceback__
    while traceback is not None:
        module = str(traceback.tb_frame.f_globals.get("__name__", ""))
        if not package or module.partition(".")[0] == package:
            place = f"{module}:{traceback.tb_lineno}"
        traceback = traceback.tb_next
    return place or "in the call"


@contextmanager
def _limited(seconds: float) -> Iterator[None]:
    """Stop what runs within after so many seconds; elsewhere than on a main thread, never."""
    if not hasattr(signal, "SIGALRM") or threading.current_thread() is not threading.main_thread():
        yield
        return

    start, start_s = time.process_time(), time.perf_counter()

    def stop(number: int, frame: FrameType | None) -> None:
        spent, clock_s = time.process_time() - start, time.perf_counter() - start_s
        waits = clock_s >= WAITS_S and spent < clock_s / IDLE
        if spent >= seconds or clock_s > IDLE * seconds or waits:
            raise _TooLong
        signal.setitimer(signal.ITIMER_REAL, min(seconds - spent, WAITS_S))

    before = signal.signal(signal.SIGALRM, stop)
    signal.setitimer(signal.ITIMER_REAL, min(seconds, WAITS_S))
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
