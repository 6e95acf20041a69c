"""Let one process at a time do what only one may; the system frees the lock of one that dies."""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from pathlib import Path
from typing import IO

Name = str | os.PathLike[str]
MOST_TRIES = 20
"""To lock a file that has the lock's name still."""


class Lock:
    """A lock on a file of its own, held by one process, and within it by one holder, at a time.

    Parameters
    ----------
    name : path
        Of the lock's file. It is made when the lock is first taken, and stays but for `remove`.
    """

    def __init__(self, name: Name) -> None:
        self.path = Path(name)
        self._file: IO[bytes] | None = None

    @property
    def held(self) -> bool:
        """Whether this holder has it."""
        return self._file is not None

    def take(self) -> bool:
        """Take the lock if nobody holds it; return whether it is held now.

        Raises
        ------
        OSError
            If the file cannot be made, or its file system knows no locks.
        """
        if self._file is None:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            any(self._taken(trusting=k == MOST_TRIES) for k in range(MOST_TRIES + 1))
        return self.held

    def _taken(self, trusting: bool) -> bool:
        """Take the lock if nobody holds it; return whether the file locked was the lock's still.

        Where another removed it in between, a third could lock a new one of its name. Who is
        ``trusting`` asks no more: there are file systems that number an open file otherwise.
        """
        file = self.path.open("ab")
        try:
            if not locked(file):
                return True
            if not (trusting or self._names(file)):
                return False
            self._file = file
            return True
        finally:
            if self._file is None:
                file.close()

    def _names(self, file: IO[bytes]) -> bool:
        try:
            return os.path.samestat(os.fstat(file.fileno()), self.path.stat())
        except FileNotFoundError:
            return False

    def release(self) -> None:
        """Let the next one take it; nothing if it is not held."""
        if self._file is not None:
            self._file.close()
            self._file = None

    def remove(self) -> None:
        """Let the next one take it, and remove its file, where nothing is left that it is for."""
        if self._file is not None:
            with suppress(OSError):  # Windows removes no open file
                self.path.unlink()
            self.release()


def locked(file: IO[bytes], at: int = 0) -> bool:
    """Lock an open file until it is closed, if nobody holds it; return whether it is locked now.

    Parameters
    ----------
    file : binary file
        Open for writing.
    at : int
        Which byte is locked, where files are locked by bytes (Windows): others cannot read it
        then. It need not be there.

    Raises
    ------
    OSError
        If its file system knows no locks.
    """
    try:
        _lock(file, at)
    except BlockingIOError:
        return False
    return True


def is_locked(name: Name, at: int = 0) -> bool:
    """Return whether another holds a file; not one that is not there, or cannot be locked."""
    try:
        with Path(name).open("r+b") as file:
            return not locked(file, at)
    except OSError:
        return False


if sys.platform == "win32":
    import msvcrt

    def _lock(file: IO[bytes], at: int) -> None:
        file.seek(at)
        try:
            msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
        except PermissionError as error:
            raise BlockingIOError(*error.args) from error

else:
    import fcntl

    def _lock(file: IO[bytes], at: int) -> None:
        fcntl.flock(file.fileno(), fcntl.LOCK_EX | fcntl.LOCK_NB)
