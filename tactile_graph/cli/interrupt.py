"""Ctrl-C, and what else ends programs, between lines, never within one."""

from __future__ import annotations

import _thread
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType, TracebackType
from typing import Any, ClassVar

ENDS = tuple(
    signal.Signals(getattr(signal, name))
    for name in ("SIGTERM", "SIGHUP")  # the latter is not on Windows
    if hasattr(signal, name)
)
"""What comes at a shutdown, from a batch system, from a terminal that is closed."""
AGAIN_S = 0.02
"""Until what a callback has swallowed comes again."""
PATIENCE_S = 0.5
"""For which what is being written may go on after a signal, before the next one ends it."""


class Ended(KeyboardInterrupt):
    """A signal ends the program: what was done is kept as with Ctrl-C.

    Parameters
    ----------
    number : int
        The signal's.
    """

    def __init__(self, number: int) -> None:
        super().__init__(number)
        self.number = number


def code_of(error: BaseException) -> int:
    """Return the exit code that tells by which signal a command ended."""
    return 128 + (error.number if isinstance(error, Ended) else signal.SIGINT)


def words_of(error: BaseException) -> str:
    """Return what to say of a command that Ctrl-C or a signal ended."""
    if isinstance(error, Ended):
        return f"ended by {signal.Signals(error.number).name}"
    return "interrupted"


class Interrupts:
    """While entered, Ctrl-C raises KeyboardInterrupt, but not inside ``with interrupts.held:``.

    There it waits for the end of the block, so that what is being written is written whole; one
    that comes `PATIENCE_S` after it waits no more, for a block may never end. Where somebody else
    is waited for as long (`reader_awaited`), the first one comes again by itself. The signals that
    end programs raise `Ended` likewise. One that is ignored (nohup) stays so. What is raised where
    Python lets no error out, as in a callback that a library's machine code calls, or in a
    ``__del__``, comes again right after.

    Attributes
    ----------
    politely : callable, optional
        Asked when the first signal comes: true if the work then ends by itself, and nothing is
        raised but at the next one.
    heeded : KeyboardInterrupt, optional
        What was not raised for that.
    """

    latest: ClassVar[KeyboardInterrupt | None] = None
    """What was raised last: a library may catch it and raise something else."""

    def __init__(self) -> None:
        self.held = _Held()
        self.politely: Callable[[], bool] | None = None
        self.heeded: KeyboardInterrupt | None = None
        self._before: dict[int, Any] = {}
        self._told_before: Any = None

    def __enter__(self) -> Interrupts:
        if threading.current_thread() is threading.main_thread():
            for number in (signal.SIGINT, *ENDS):
                if signal.getsignal(number) is not signal.SIG_IGN:
                    self._before[number] = signal.signal(number, self._came)
            owners = (getattr(handler, "__self__", None) for handler in self._before.values())
            if not any(isinstance(owner, Interrupts) for owner in owners):
                Interrupts.latest = None  # what came was for a command before
            self._told_before, sys.unraisablehook = sys.unraisablehook, self._swallowed
        return self

    def __exit__(self, *_: object) -> None:
        for number, before in self._before.items():
            signal.signal(number, before)
        if self._told_before is not None:
            sys.unraisablehook, self._told_before = self._told_before, None

    def again(self) -> None:
        """Raise what was raised already and swallowed by code that it came through, as an import.

        For a loop without an end of its own, which would go on as if no signal had come.
        """
        if Interrupts.latest is not None and not self.held.depth:
            raise Interrupts.latest

    def _swallowed(self, what: Any) -> None:
        """Have a signal come again that was raised in vain; other errors are told as before."""
        error = Interrupts.latest
        if error is None or error is not what.exc_value:
            (self._told_before or sys.__unraisablehook__)(what)
            return
        again = threading.Timer(AGAIN_S, _send, (code_of(error) - 128,))
        again.daemon = True
        again.start()

    def _came(self, number: int, _frame: FrameType | None) -> None:
        error = KeyboardInterrupt() if number == signal.SIGINT else Ended(number)
        if self.politely is not None and self.heeded is None and self.politely():
            self.heeded = error
            return
        Interrupts.latest = error
        if not self.held.keeps(error, number):
            raise error


def _send(number: int) -> None:
    """Send the main thread a signal that wakes it, whatever it waits for."""
    if hasattr(signal, "pthread_kill"):  # not on Windows
        signal.pthread_kill(threading.main_thread().ident or 0, number)
    else:
        _thread.interrupt_main(signal.Signals(number))


@contextmanager
def reader_awaited() -> Iterator[None]:
    """Tell that what is done in the block hangs on who reads a pipe, who may never do so."""
    _Held.n_awaited += 1
    _Held.awaited_since_s = time.monotonic()
    try:
        yield
    finally:
        _Held.n_awaited -= 1


class _Held:
    n_awaited: ClassVar[int] = 0
    """How many blocks wait for a reader."""
    awaited_since_s: ClassVar[float] = 0.0
    """When the latest of them began."""

    def __init__(self) -> None:
        self.depth = 0
        self.waiting: KeyboardInterrupt | None = None
        self._since_s = 0.0

    def keeps(self, error: KeyboardInterrupt, number: int) -> bool:
        """Return whether what a signal raises waits for the end of the block."""
        if not self.depth:
            return False
        if self.waiting is not None:
            return time.monotonic() - self._since_s < PATIENCE_S
        self.waiting, self._since_s = error, time.monotonic()
        self._again_later(error, number)
        return True

    def _again_later(self, error: KeyboardInterrupt, number: int) -> None:
        again = threading.Timer(PATIENCE_S, self._again, (error, number))
        again.daemon = True
        again.start()

    def _again(self, error: KeyboardInterrupt, number: int) -> None:
        if self.waiting is not error:
            return
        if self.n_awaited and time.monotonic() - self.awaited_since_s >= PATIENCE_S:
            _send(number)
        self._again_later(error, number)

    def __enter__(self) -> None:
        self.depth += 1

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.depth -= 1
        if self.waiting is not None and not self.depth:
            waiting, self.waiting = self.waiting, None
            raise waiting
