"""Hidden names under which files are written until they are whole; what killed ones left goes."""

from __future__ import annotations

import glob
import os
import platform
import shutil
import zlib
from functools import cache
from pathlib import Path


def part_of(target: Path) -> Path:
    """Return the hidden name beside a file under which this process writes it.

    What processes of this machine that are there no more have left of the same file, since they
    were killed, is removed.
    """
    for left in target.parent.glob(f".{glob.escape(target.name)}.*.part"):
        machine, _, process = left.name.split(".")[-2].rpartition("-")
        if machine == _machine() and process.isdigit() and not _runs(int(process)):
            remove(left)
    return target.with_name(f".{target.name}.{_machine()}-{os.getpid()}.part")


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
    """Return whether there is such a process; taken for granted where asking would end it."""
    if process == os.getpid():
        return True
    if os.name == "nt":
        return True
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except (OSError, OverflowError):  # of another user
        return True
    return True
