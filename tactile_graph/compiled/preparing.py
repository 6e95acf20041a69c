"""Who waits for the compiler is told what is prepared and how far it is."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TextIO

from tactile_graph.foreign_text import tell

WORTH_A_LINE_S = 1.0
REDRAW_S = 0.1
NEXT_LINE_S = 5.0

Teller = Callable[[str | None], None]
"""Takes what to say, again and again; None when all is prepared."""

_tellers: list[Teller] = []


@contextmanager
def told_by(teller: Teller) -> Iterator[None]:
    """Let ``teller`` say what is prepared, in place of whoever did.

    The first one starts the clock: what was prepared before kept nobody waiting who listens.
    """
    if not _tellers:
        preparing.start_clock()
    _tellers.append(teller)
    try:
        yield
    finally:
        _tellers.remove(teller)


class Line:
    """Says it on a stream: on a terminal one line that changes, in a log one every few seconds."""

    def __init__(self, stream: TextIO | None = None) -> None:
        self._stream = stream
        self._next = 0.0
        self._drawn = False

    def __call__(self, text: str | None) -> None:
        """Say ``text``, or take the line away."""
        stream = self._stream or sys.stderr
        on_terminal = stream.isatty()
        now = time.monotonic()
        if text is None:
            if self._drawn and on_terminal:
                stream.write("\r\x1b[K")
                stream.flush()
            self._drawn = False
        elif now >= self._next:
            stream.write(f"\r{text}\x1b[K" if on_terminal else f"{text}\n")
            stream.flush()
            self._drawn = True
            self._next = now + (REDRAW_S if on_terminal else NEXT_LINE_S)


class Preparing:
    """One kernel, while it and all kernels within are compiled.

    Attributes
    ----------
    on_first : callable or None
        Called once, when the next kernel is about to be compiled.
    helped : bool
        Whether another process compiles meanwhile.
    n_made : int
        How often machine code was made or loaded so far, by whoever asked for it.
    not_kept : str
        What is to be said of machine code that could not be kept on disk; "" where all was.
    """

    def __init__(self) -> None:
        self.on_first: Callable[[], None] | None = None
        self.helped = False
        self.n_made = 0
        self.not_kept = ""
        self._name = ""
        self._total = 0
        self._done: set[int] = set()
        self._spent_s = 0.0
        self._since = 0.0

    @property
    def spent_s(self) -> float:
        """Time that was spent on it since the clock was started, waiting for others included."""
        return self._spent_s

    def start_clock(self) -> None:
        """Count the time spent from now on."""
        self._spent_s = 0.0

    @contextmanager
    def of(self, name: str, total: int) -> Iterator[None]:
        """Say how far the kernel ``name`` is, of ``total`` kernels, until it is done."""
        self._name, self._total, self._since = name, total, time.monotonic()
        self._done.clear()
        start, self.on_first = self.on_first, None
        if start is not None:
            start()
        try:
            yield
        finally:
            self._spent_s += time.monotonic() - self._since
            if _tellers:
                _tellers[-1](None)

    def at(self, function: object) -> None:
        """Note that ``function`` is compiled now."""
        self._done.add(id(function))
        n = min(len(self._done), self._total)
        self._say(f"{n} of {self._total} kernels")

    @contextmanager
    def elsewhere(self, name: str) -> Iterator[Callable[[], None]]:
        """Give what says, again and again, that another process compiles the kernel ``name``."""
        since = time.monotonic()

        def tell() -> None:
            spent_s = self._spent_s + time.monotonic() - since
            if _tellers and spent_s > WORTH_A_LINE_S:
                _tellers[-1](
                    f"another process compiles {name}, once on this machine, {spent_s:.0f} s"
                )

        try:
            yield tell
        finally:
            self._spent_s += time.monotonic() - since
            if _tellers:
                _tellers[-1](None)

    def meanwhile(self, name: str, since_s: float) -> None:
        """Note that plain code has answered while another process compiles the kernel ``name``."""
        if _tellers and since_s > WORTH_A_LINE_S:
            _tellers[-1](
                f"plain code answers while another process compiles {name}, "
                f"once on this machine, {since_s:.0f} s"
            )

    def unkept(self, why: str) -> None:
        """Note that machine code could not be kept on disk, and why; a command says so once."""
        first, self.not_kept = (
            not self.not_kept,
            (
                f"machine code cannot be kept for the next time ({why}); "
                "set NUMBA_CACHE_DIR to a folder that takes it"
            ),
        )
        if first and _tellers:
            _tellers[-1](None)
            tell(f"hint: {self.not_kept}")

    def all_told(self) -> None:
        """Take the line away."""
        if _tellers:
            _tellers[-1](None)

    def all_together(self) -> None:
        """Note that the code of all is optimised and made into machine code."""
        self._say(f"{self._total} kernels into one")

    def _say(self, what: str) -> None:
        spent_s = self._spent_s + time.monotonic() - self._since
        if _tellers and spent_s > WORTH_A_LINE_S:
            beside = "; another process compiles what comes later" if self.helped else ""
            _tellers[-1](
                f"compiling {self._name}, once on this machine: {what}, {spent_s:.0f} s{beside}"
            )


preparing = Preparing()
