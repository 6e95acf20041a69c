"""One process at a time writes to a store."""

from __future__ import annotations

import os
import platform
import time
from pathlib import Path

from tactile_graph.errors import UsageError
from tactile_graph.files import said
from tactile_graph.locks import Lock


class SoleWriter:
    """The right to write to a store, which one process at a time has.

    Two files stand beside the store, hidden: the lock, which stays with it, and who holds it.
    """

    def __init__(self, path: Path, called: Path | None = None) -> None:
        self.path = path
        self._called = called or path
        self._lock = Lock(path.with_name(f".{path.name}.lock"))
        self._holder = path.with_name(f".{path.name}.writer")

    def take(self) -> None:
        """Take it, or say who has it.

        Raises
        ------
        UsageError
        """
        with said(self._called):
            if not self._lock.take():
                raise UsageError(f"{self._called}: is being written to{self._who()}")
            since = time.strftime("%Y-%m-%d %H:%M:%S")
            name = f"process {os.getpid()} on {platform.node()}, since {since}"
            try:
                self._holder.write_text(name, encoding="utf-8")
            except OSError:
                self.release()
                raise

    def _who(self) -> str:
        try:
            return f" by {self._holder.read_text(encoding='utf-8')[:200]}"
        except OSError:  # it has the lock, and has not written down who it is
            return " by another process"

    def release(self) -> None:
        """Give it back."""
        if self._lock.held:
            self._holder.unlink(missing_ok=True)
            if self.path.exists():
                self._lock.release()
            else:
                self._lock.remove()
