"""Run a plugin's code while it is imported: it prints nowhere, ends nothing, and hangs by name."""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, redirect_stdout, suppress
from types import FrameType
from typing import Any

STDOUT, STDERR = 1, 2
"""Descriptors."""
SLOW_S = 5.0
"""How long an import may take until it is told who takes so long."""


class Broken(Exception):  # noqa: N818 -- what became of the plugin
    """Whatever a plugin's code raised, KeyboardInterrupt and SystemExit too; it is the cause."""

    @property
    def error(self) -> BaseException:
        """What was raised."""
        assert self.__cause__ is not None
        return self.__cause__


@contextmanager
def foreign_code(name: str, label: str) -> Iterator[None]:
    """Run a plugin's code; what it prints goes to stderr: lines for programs own stdout.

    Parameters
    ----------
    name, label : str
        The plugin, as ``--plugins`` takes it and as errors name it.

    Raises
    ------
    Broken
        Whatever was raised in it, unless it was Ctrl-C or another signal.
    """
    told = threading.Timer(SLOW_S, _tell, (name, label))
    told.daemon = True
    with _Signals() as signals:
        told.start()
        try:
            with stdout_to_stderr():
                yield
        except BaseException as error:
            if signals.came is None:
                raise Broken from error
            raise signals.came from None  # what was imported may have made another error of it
        finally:
            told.cancel()
        if signals.came is not None:  # or it may have gone on, as if none had come
            raise signals.came


class _Diverted:
    """Who has stdout go to stderr just now: threads may import at once, the last puts it back."""

    def __init__(self) -> None:
        self.lock = threading.Lock()
        self.n = 0
        self.back = ExitStack()
        self.kept: int | None = None
        """The descriptor that is stdout's meanwhile."""


_DIVERTED = _Diverted()


@contextmanager
def stdout_to_stderr() -> Iterator[None]:
    """Have what is printed, or written to stdout's descriptor as C does, go to stderr."""
    with _DIVERTED.lock:
        if not _DIVERTED.n:
            _DIVERTED.back.enter_context(redirect_stdout(sys.stderr))
            _divert(_DIVERTED.back)
        _DIVERTED.n += 1
    try:
        yield
    finally:
        with _DIVERTED.lock:
            _DIVERTED.n -= 1
            if not _DIVERTED.n:
                _DIVERTED.back.close()


@contextmanager
def stdout_again() -> Iterator[None]:
    """Have stdout's descriptor be its own meanwhile, for what writes there on purpose."""
    if (kept := _DIVERTED.kept) is None:
        yield
        return
    _flush_c()
    os.dup2(kept, STDOUT)
    try:
        yield
    finally:
        _flush_c()
        with suppress(OSError):  # there may be no stderr
            os.dup2(STDERR, STDOUT)


def _divert(back: ExitStack) -> None:
    with suppress(OSError, ValueError, AttributeError):  # there may be no stdout, or a closed one
        sys.__stdout__.flush()  # type: ignore[union-attr]
    try:
        kept = os.dup(STDOUT)
    except OSError:
        return
    back.callback(os.close, kept)
    back.callback(os.dup2, kept, STDOUT)
    back.callback(_flush_c)
    back.callback(setattr, _DIVERTED, "kept", None)
    _DIVERTED.kept = kept
    with suppress(OSError):  # there may be no stderr
        os.dup2(STDERR, STDOUT)


def _flush_c() -> None:
    """Have C write what it was told to print, before stdout is another's again."""
    ctypes = sys.modules.get("ctypes")  # loading it would take longer than most plugins
    with suppress(OSError, TypeError, AttributeError):  # there may be no C library to ask
        ctypes.CDLL(None).fflush(None)  # type: ignore[union-attr]


def _tell(name: str, label: str) -> None:
    from tactile_graph.foreign_text import tell

    tell(f"{label} is still being imported after {SLOW_S:g} s; --plugins=-{name} does without it")


class _Signals:
    """Tells a KeyboardInterrupt that a signal brought from one that a plugin raises itself."""

    def __init__(self) -> None:
        self.came: BaseException | None = None
        self._before: dict[int, Any] = {}

    def __enter__(self) -> _Signals:
        if threading.current_thread() is threading.main_thread():
            for name in ("SIGINT", "SIGTERM", "SIGHUP"):
                number = getattr(signal, name, None)  # the last is not on Windows
                before = None if number is None else signal.getsignal(number)
                if number is not None and callable(before):
                    self._before[number] = before
                    signal.signal(number, self._note)
        return self

    def __exit__(self, *_: object) -> None:
        for number, before in self._before.items():
            # A plugin may have set a handler of its own meanwhile: that one stays.
            if signal.getsignal(number) == self._note:
                signal.signal(number, before)

    def _note(self, number: int, frame: FrameType | None) -> None:
        try:
            self._before[number](number, frame)
        except BaseException as error:
            self.came = error
            raise
