"""Test processes that share numba's cache on disk compile each kernel once, not once each."""

from __future__ import annotations

import hashlib
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any


def compile_once_among_processes() -> None:
    """Let whoever needs a kernel that another process is compiling wait and load it then.

    The lock of a function is taken before those of the functions it calls, and inside numba's
    own lock among threads, so nobody waits in a circle.
    """
    try:
        import fcntl
    except ImportError:  # Windows: each compiles for itself
        return
    from numba.core.compiler_lock import global_compiler_lock
    from numba.core.dispatcher import Dispatcher

    folder = Path(tempfile.gettempdir()) / "tactile-graph-kernels"
    folder.mkdir(exist_ok=True)
    unlocked = Dispatcher.compile
    held: set[str] = set()

    @contextmanager
    def lock(function: Any) -> Iterator[None]:
        where = f"{function.__code__.co_filename}:{function.__qualname__}"
        if where in held:
            yield
            return
        held.add(where)
        with (folder / hashlib.sha256(where.encode()).hexdigest()).open("w") as file:
            fcntl.flock(file, fcntl.LOCK_EX)
            try:
                yield
            finally:
                held.discard(where)

    def compile(self: Any, signature: Any) -> Any:
        with global_compiler_lock, lock(self.py_func):
            return unlocked(self, signature)

    Dispatcher.compile = compile
