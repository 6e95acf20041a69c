"""What is done to this process while steps are at work, counted so that a frame looks only then."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any


class Changes:
    """How often something was done to this process that steps should leave alone.

    Attributes
    ----------
    n : int
        Grows with each change of folder in a command, and in the copy that a fork makes.
    forked_at : int
        What it was when this process was forked.
    home : str
        The folder that a command began in; "" where there is none.
    away : str
        The folder that its steps have gone to; "" where they are at home.
    """

    __slots__ = ("away", "forked_at", "home", "n")

    def __init__(self) -> None:
        self.n, self.forked_at = 0, -1
        self.home = self.away = ""

    def forked(self) -> None:
        """Note, in the copy, that this process was forked."""
        self.forked_at = self.n
        self.n += 1

    def heard(self, event: str, _: tuple[Any, ...]) -> None:
        """Note, as an audit hook, that somebody goes to another folder."""
        if event == "os.chdir":
            self.n += 1


changes = Changes()
_listening = False
if hasattr(os, "register_at_fork"):  # not on Windows
    os.register_at_fork(after_in_child=changes.forked)


@contextmanager
def home_kept() -> Iterator[None]:
    """Have only steps, and only while they are at work, be in another folder than this one."""
    global _listening
    if not _listening:
        _listening = True
        sys.addaudithook(changes.heard)  # that cannot be undone
    with suppress(OSError):  # it may be gone
        changes.home = os.getcwd()
    try:
        yield
    finally:
        changes.home = changes.away = ""
