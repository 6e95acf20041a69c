"""What steps change of the process that they share with the source and with what is written.

Where a step goes to another folder, that holds for steps alone, and where it has NumPy raise, for
its frame: sources and writers, whose files are named from the folder the command began in, find
both as they were. The copy of the process that a step forks ends where the frame's steps do, and
does none of the other's work.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any

from tactile_graph.changes import changes

try:
    from numpy._core.umath import _extobj_contextvar as _errors
except ImportError:  # of NumPy 1, where asking for it costs a frame too much
    errors_of_numpy: Any = lambda: None  # noqa: E731
else:
    errors_of_numpy = _errors.get


def go_away() -> None:
    """Go where steps have gone."""
    with suppress(OSError):  # gone meanwhile
        os.chdir(changes.away)


def put_right(before: int, errors: Any) -> None:
    """Put right what steps have changed.

    Parameters
    ----------
    before : int
        What `changes` counted before them.
    errors : object
        What `errors_of_numpy` gave before them.
    """
    if changes.forked_at >= before:
        _end_copy(sys.exc_info()[1])
    if errors_of_numpy() is not errors:
        _errors.set(errors)
    if changes.home and changes.n != before:
        with suppress(OSError):  # one of the two is gone
            there = os.getcwd()
            changes.away = there if there != changes.home else ""
            if changes.away:
                os.chdir(changes.home)


@contextmanager
def righted() -> Iterator[None]:
    """Put right afterwards what a step changes meanwhile; it begins at home."""
    before, errors = changes.n, errors_of_numpy()
    try:
        yield
    finally:
        if changes.n != before or errors_of_numpy() is not errors:
            put_right(before, errors)


@contextmanager
def steps_at_work() -> Iterator[None]:
    """Put right afterwards what steps change meanwhile; they begin where they have gone before."""
    with righted():
        if changes.away:
            go_away()
        yield


def _end_copy(error: BaseException | None) -> None:
    """End the copy that a fork made, with the code that it was to end with."""
    code = getattr(error, "code", 1) if error is not None else 0
    os._exit(code if isinstance(code, int) else int(code is not None))
