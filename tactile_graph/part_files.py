"""Hidden names under which files are written until they are whole; what killed ones left goes."""

from __future__ import annotations

import errno
import glob
import os
import platform
import shutil
import sys
import zlib
from contextlib import suppress
from functools import cache
from pathlib import Path

from tactile_graph.errors import UsageError

_HELD = (errno.EACCES, errno.EPERM, errno.EBUSY)
"""A file cannot be replaced: a program has it open on Windows, it is another person's in a folder
for all, or a disc of its own is mounted on it.
"""
_NO_RENAMING = (errno.ENOSYS, errno.EOPNOTSUPP, errno.EXDEV)
"""A file system knows no renaming, or not there."""

LONGEST = 200
"""Bytes of a name from which on a hidden one holds but its beginning."""


def part_of(target: Path) -> Path:
    """Return the hidden name beside a file under which this process writes it.

    What processes of this machine that are there no more have left of the same file, since they
    were killed, is removed; an older folder that was being replaced just then gets its name back.
    """
    before = f".{_short(target.name)}.{_machine()}-"
    for end in (".part.old", ".part"):
        for left in target.parent.glob(f"{glob.escape(before)}*{end}"):
            process = left.name.removeprefix(before).removesuffix(end)
            if not process.isdecimal() or _runs(int(process)):
                continue
            if end == ".part.old" and not os.path.lexists(target):
                with suppress(OSError):
                    left.rename(target)
            else:
                remove(left)
    return target.with_name(f"{before}{os.getpid()}.part")


def put_in_place(part: Path, target: Path, called: str | os.PathLike[str]) -> None:
    """Give a whole file, or a folder that stands for one, its name, in place of what is there.

    A folder is exchanged with the older one at once where the system can do that; elsewhere there
    is none of that name between two renames.

    Parameters
    ----------
    part, target : Path
        In the same folder.
    called : path
        The target as a person named it, for the message.

    Raises
    ------
    UsageError
        If what is there can be neither replaced nor written into. The new one then lies beside it,
        under a name that the message says.
    OSError
        If the system refuses for another reason.
    """
    try:
        if target.is_dir():
            _put_over_folder(part, target)
        else:
            os.replace(part, target)
    except OSError as error:
        if error.errno not in _HELD:
            raise
        beside = target.with_name(f"{target.stem}.new-{os.getpid()}{target.suffix}")
        _move(part, beside)  # from now on a kill leaves it as well
        try:
            if beside.is_dir():
                raise error  # no folder is written into another
            _write_into(target, beside)
        except OSError as last:
            told = f"{os.fspath(called)}: cannot be written: {last.strerror or last}"
            told += f"; it lies whole in {beside}"
            old = _old_of(target)
            raise UsageError(f"{told}, the older one in {old}" if old.exists() else told) from last


def put_over(new: Path, older: Path) -> None:
    """Give a file the name of an older one, or write it into that where it cannot be replaced.

    Raises
    ------
    OSError
        If neither can be done; the new one is still there.
    """
    try:
        os.replace(new, older)
    except OSError as error:
        if error.errno not in (*_HELD, *_NO_RENAMING):
            raise
        _write_into(older, new)


def _write_into(older: Path, new: Path) -> None:
    with new.open("rb") as source, older.open("wb") as file:
        shutil.copyfileobj(source, file)
        file.flush()
        os.fsync(file.fileno())  # the other copy goes now
    remove(new)


def _move(part: Path, beside: Path) -> None:
    try:
        os.replace(part, beside)
    except OSError:  # as where something looks through it on Windows
        if part.is_dir():
            shutil.copytree(part, beside)
        else:
            shutil.copyfile(part, beside)
        remove(part)


def _put_over_folder(part: Path, target: Path) -> None:
    if _exchanged(part, target):
        remove(part)
        return
    old = _old_of(target)  # a folder that is not empty is not replaced
    target.rename(old)
    try:
        part.rename(target)
    except OSError:
        old.rename(target)
        raise
    remove(old)


def _old_of(target: Path) -> Path:
    """Return the name of an older folder while it is replaced; `part_of` finds it after a kill."""
    return target.with_name(f".{_short(target.name)}.{_machine()}-{os.getpid()}.part.old")


def _short(name: str) -> str:
    """Return a name that leaves room for what a hidden one has more: file systems end at 255."""
    if len(os.fsencode(name)) <= LONGEST:
        return name
    return f"{name[:40]}~{zlib.crc32(os.fsencode(name)):08x}"


def _exchanged(one: Path, other: Path) -> bool:
    """Return whether two names changed places, which Linux alone offers, not on every disc."""
    import ctypes

    exchange = getattr(ctypes.CDLL(None), "renameat2", None) if sys.platform == "linux" else None
    if exchange is None:
        return False
    here, flag = -100, 2  # AT_FDCWD and RENAME_EXCHANGE of renameat2(2)
    return bool(exchange(here, os.fsencode(one), here, os.fsencode(other), flag) == 0)


def remove(part: Path) -> None:
    """Remove a file, or a folder that stands for one; what cannot be removed stays."""
    if part.is_dir() and not part.is_symlink():
        shutil.rmtree(part, ignore_errors=True)
        return
    try:
        part.unlink(missing_ok=True)
    except OSError:  # as a file that is open, on Windows
        return


@cache
def _machine() -> str:
    """Return what tells processes with the same number apart, which run on several machines.

    A folder may be shared by machines, and by containers that have a machine's name.
    """
    try:
        numbered_by = os.readlink("/proc/self/ns/pid")
    except OSError:
        numbered_by = ""
    return f"{zlib.crc32(f'{platform.node()} {numbered_by}'.encode()):08x}"


def _runs(process: int) -> bool:
    """Return whether there is such a process; taken for granted where nobody can tell."""
    if process == os.getpid():
        return True
    if sys.platform == "win32":  # signal 0 would end it there
        import ctypes

        if process >= 1 << 32:
            return True
        kernel = ctypes.WinDLL("kernel32", use_last_error=True)
        handle = kernel.OpenProcess(0x0010_0000, False, process)  # SYNCHRONIZE: may be waited for
        if not handle:
            return ctypes.get_last_error() != 87  # ERROR_INVALID_PARAMETER: there is none
        ended = kernel.WaitForSingleObject(handle, 0) == 0
        kernel.CloseHandle(handle)
        return not ended
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except (OSError, OverflowError):  # of another user
        return True
    return True
