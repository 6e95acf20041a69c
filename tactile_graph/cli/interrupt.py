"""Ctrl-C between lines, never within one."""

from __future__ import annotations

import signal
import threading
from types import FrameType, TracebackType
from typing import Any


class Interrupts:
    """While entered, Ctrl-C raises KeyboardInterrupt, but not inside ``with interrupts.held:``.

    There it waits for the end of the block, so that what is being written is written whole.
    """

    def __init__(self) -> None:
        self.held = _Held()
        self._before: Any = None
        self._here = threading.current_thread() is threading.main_thread()

    def __enter__(self) -> Interrupts:
        if self._here:
            self._before = signal.signal(signal.SIGINT, self._came)
        return self

    def __exit__(self, *_: object) -> None:
        if self._here:
            signal.signal(signal.SIGINT, self._before)

    def _came(self, _signal: int, _frame: FrameType | None) -> None:
        if self.held.depth:
            self.held.waiting = True
        else:
            raise KeyboardInterrupt


class _Held:
    def __init__(self) -> None:
        self.depth = 0
        self.waiting = False

    def __enter__(self) -> None:
        self.depth += 1

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.depth -= 1
        if self.waiting and not self.depth:
            self.waiting = False
            raise KeyboardInterrupt
