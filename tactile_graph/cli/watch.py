"""Do something again whenever a file that it reads is saved."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from tactile_graph.cli.say import clock
from tactile_graph.files import LOOKED_FOR, named_from_folder

if TYPE_CHECKING:
    from rich.console import Console

INTERVAL_S, SETTLED_S = 0.3, 0.1
"""Between two looks at the files, and without a change after one: editors write in several steps,
or put a new file in the place of the old one, which is gone for a moment."""
DATA = (".yaml", ".yml", ".json", ".csv", ".npz", ".npy")
"""Endings of files that are read anew each time; code is not, within one process."""
PACKAGES = ("site-packages", "dist-packages")
"""Folders of what is installed, which nobody edits."""

Stamp = tuple[int, int, int] | None
"""When a file was written, its size and its number; None where there is none."""


def watch(
    look: Callable[[], bool],
    named: Iterable[str | os.PathLike[str]],
    out: Console,
    wait: Callable[[float], None] = time.sleep,
) -> bool:
    """Look, and again at each change of a named file or one that was read, until Ctrl-C.

    Parameters
    ----------
    look : callable
        Returns whether all was right.
    named : iterable of path
        Watched even where the look does not come to read them.
    out : Console
        Told what was saved before each further look.
    wait : callable
        Waits so many seconds.

    Returns
    -------
    bool
        Whether all was right at the last look that came to its end; where there is no file to
        watch that is the first.
    """
    right = False
    always = [os.fspath(path) for path in named]
    stamps: dict[str, Stamp] = {}
    try:
        while True:
            before = {path: stamp(path) for path in [*always, *stamps]}
            read: dict[str, Stamp] = {}
            with files_read(read):
                right = look()
            # What is wrong may keep a file from being read, or be that it is gone.
            kept = before if not right else {p: before[p] for p in before if p in read}
            stamps = read | {p: before[p] for p in always} | kept
            if not stamps:
                out.print("there is no file to watch", style="dim")
                return right
            out.print(f"watching {_counted(len(stamps))}; Ctrl-C ends", style="dim")
            changed = _next_change(stamps, wait)
            out.print()
            out.print(f"{clock()}  {', '.join(changed)} changed", style="bold", soft_wrap=True)
    except KeyboardInterrupt:
        return right


def _counted(n: int) -> str:
    return f"{n} file{'s' if n != 1 else ''}"


def _next_change(stamps: Mapping[str, Stamp], wait: Callable[[float], None]) -> list[str]:
    """Wait until files are no longer what they were, and for them to settle; return which."""
    while (now := {path: stamp(path) for path in stamps}) == stamps:
        wait(INTERVAL_S)
    settled = False
    while not settled:
        wait(SETTLED_S)
        later = {path: stamp(path) for path in stamps}
        settled, now = later == now, later
    changed = [named_from_folder(path) for path in stamps if now[path] != stamps[path]]
    return changed or ["a file"]


def stamp(path: str) -> Stamp:
    """Return what changes of a file when it is saved or replaced."""
    try:
        found = os.stat(path)
    except OSError:
        return None
    return found.st_mtime_ns, found.st_size, found.st_ino


@contextmanager
def files_read(stamps: dict[str, Stamp]) -> Iterator[None]:
    """Enter each file of data that is opened meanwhile, as it is then, or looked for in vain."""
    global _reading
    _install()
    _reading = stamps
    try:
        yield
    finally:
        _reading = None


_reading: dict[str, Stamp] | None = None
_installed = False


def _install() -> None:
    """Have Python tell of every file it opens; that cannot be undone, only left unheard."""
    global _installed
    if not _installed:
        _installed = True
        sys.addaudithook(_note)


def _note(event: str, args: tuple[Any, ...]) -> None:
    if event not in ("open", LOOKED_FOR) or _reading is None:
        return
    if not isinstance(args[0], str | os.PathLike):
        return
    path = os.fspath(args[0])
    to_read = event != "open" or not isinstance(args[1], str) or args[1].startswith("r")
    if not isinstance(path, str) or not to_read or not path.endswith(DATA) or path in _reading:
        return
    if not any(folder in path for folder in PACKAGES):
        _reading[path] = stamp(path)
