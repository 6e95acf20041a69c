"""Write files that are there whole or not at all, and say beforehand what cannot be written.

Who watches files hears here of those that are looked for and not there.
"""

from __future__ import annotations

import hashlib
import os
import re
import signal
import stat
import sys
import threading
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import Any, BinaryIO

from tactile_graph.errors import UsageError, did_you_mean
from tactile_graph.part_files import part_of, put_in_place, remove

Name = str | os.PathLike[str]
LOOKED_FOR = "tactile_graph.looked_for"
"""Python's audit event of a file that is not there, with its path."""
SYNCED_AT_ONCE = 16
"""Files that are put on the disc at the same time, which takes little longer than one."""
_ERRNO = re.compile(r"\berrno\W+(\d+)", re.I)


@contextmanager
def whole_file(name: Name, by: str = "") -> Iterator[BinaryIO]:
    """Give a file to write to, which gets its name, and replaces another, only at the end.

    If anything is raised meanwhile, nothing is left behind and an older file stays. A link stays a
    link. What is no plain file (a device, a pipe) takes what comes as it comes.

    Parameters
    ----------
    name : path
    by : str, optional
        Who writes it, where only one such can at a time: what one leaves behind that is killed, the
        next one takes. This process by its number otherwise.

    Raises
    ------
    UsageError
        If it cannot be written.
    """
    with said(name):
        if not is_plain(name):
            with Path(name).open("wb") as file:
                try:
                    yield file
                except KeyboardInterrupt:
                    file.raw.close()  # what is left would wait for a reader, who may never come
                    raise
            return
        target = Path(os.path.realpath(name))
        part = target.with_name(f".{target.name}.{by}.part") if by else part_of(target)
        try:
            with part.open("wb") as file:
                yield file
                file.flush()
                os.fsync(file.fileno())  # or a power cut may leave the name without the content
            if target.exists():
                part.chmod(stat.S_IMODE(target.stat().st_mode))
            put_in_place(part, target, name)
        except BaseException:
            remove(part)
            raise


@contextmanager
def whole_folder(name: Name) -> Iterator[Path]:
    """Give a path at which to make a folder, which gets its name only at the end.

    It lies in a hidden folder beside that. If anything is raised meanwhile, nothing is left behind.

    Parameters
    ----------
    name : path
        Under which there is nothing yet.

    Raises
    ------
    UsageError
        If the hidden folder cannot be made, or what is made cannot be given its name: something
        else may have got it meanwhile, which stays.
    """
    target = Path(name)
    hidden = part_of(target)
    try:
        with said(name):
            hidden.mkdir()
        made = hidden / target.name
        yield made
        if made.exists():
            if target.exists():
                raise UsageError(f"{name} is there already: it came to be meanwhile, and stays")
            with said(name):
                made.rename(target)
    finally:
        remove(hidden)


def put_on_disc(path: Path, within: Path) -> None:
    """Wait until a file, and its name in each folder up to ``within``, are on the disc."""
    put_all_on_disc([path], within)


def put_all_on_disc(paths: Sequence[Path], within: Path) -> None:
    """Wait until files, and their names in each folder up to ``within``, are on the disc."""
    from concurrent.futures import ThreadPoolExecutor

    # Windows opens no folders, and keeps their names by itself.
    parents = () if os.name == "nt" else (p for path in paths for p in path.parents)
    folders = dict.fromkeys(p for p in parents if p.is_relative_to(within))
    with ThreadPoolExecutor(SYNCED_AT_ONCE) as pool:
        list(pool.map(_synced, (*paths, *folders)))


def _synced(place: Path) -> None:
    descriptor = os.open(place, os.O_RDONLY if place.is_dir() else os.O_RDWR)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def write_whole(name: Name, content: str | bytes) -> None:
    """Write a file at once or not at all, a text as UTF-8; see `whole_file`."""
    with whole_file(name) as file:
        file.write(content.encode() if isinstance(content, str) else content)


@contextmanager
def uninterrupted(once: bool = False) -> Iterator[list[int]]:
    """Let Ctrl-C, and the signals that end programs, wait for the end of the block.

    For what several steps make and only all of them undo, and for libraries that go on writing in
    threads of their own after the call that began it was interrupted. Other threads than the main
    one get no signals; there the block runs as it is.

    Parameters
    ----------
    once : bool
        Only the first one waits; the next one acts at once.

    Yields
    ------
    list of int
        The signals that wait so far.
    """
    waiting: list[int] = []
    before: dict[int, Any] = {}
    over = False

    def wait(number: int, frame: FrameType | None) -> None:
        if over or (once and waiting):  # over: it is being raised, and this one not restored yet
            before[number](number, frame)
        waiting.append(number)

    try:
        if threading.current_thread() is threading.main_thread():
            for name in ("SIGINT", "SIGTERM", "SIGHUP"):  # the last is not on Windows
                number = getattr(signal, name, None)
                if number is not None and callable(handler := signal.getsignal(number)):
                    before[number] = handler
                    signal.signal(number, wait)
        yield waiting
    finally:
        over = True
        for number, handler in before.items():
            signal.signal(number, handler)
        if waiting:
            before[waiting[0]](waiting[0], None)


def lies_beside(file: Name, settings: Mapping[str, Any], message: str) -> str:
    """Return a hint where a file that is missed lies in the folder of the file that names it.

    Parameters
    ----------
    file : path
        The pipeline file. What ``use`` names is looked for in its folder, other files are not.
    settings : mapping
        Of the step that misses the file.
    message : str
        What it says.
    """
    for name in settings.values():
        if isinstance(name, str | Path) and Path(name).suffix and str(name) in message:
            there = Path(file).parent / name
            if not os.path.exists(name) and os.path.exists(there):
                return (
                    "; files that settings name are looked for from the current folder: "
                    f"did you mean {str(there)!r}?"
                )
    return ""


@contextmanager
def said(name: Name, left: str = "") -> Iterator[None]:
    """Say which file it is that cannot be written, and why, in place of any OSError.

    Parameters
    ----------
    name : path
    left : str, optional
        What there is of it then.

    Raises
    ------
    UsageError
    """
    try:
        yield
    except BrokenPipeError:  # whoever read it is gone: no trouble with the file
        raise
    except OSError as error:
        told = f"{os.fspath(name)}: cannot be written: {_why(error)}"
        raise UsageError(f"{told}; {left}" if left else told) from error


def _why(error: OSError) -> str:
    """Return the system's word for it, which libraries may hand on by its number in a text."""
    told = error.strerror or str(error)
    number = _ERRNO.search(told)
    return os.strerror(int(number[1])) if number else told


def left_of(target: Path) -> str:
    """Return what there is under the name of what gets it only when it is whole."""
    return "the older one stays" if target.exists() else "nothing of it is kept"


SETTLED_S = 2.0
"""From the last change of a file on, after which another would show in its time of change."""
_known: dict[tuple[int, ...], str] = {}


def sha256_of(name: Name) -> str:
    """Return the SHA-256 of a file's content; one that has not changed since is not read again.

    Raises
    ------
    OSError
        If it cannot be read.
    """
    with Path(name).open("rb") as file:
        now = os.fstat(file.fileno())
        of_file = (now.st_dev, now.st_ino, now.st_size, now.st_mtime_ns)
        found = _known.get(of_file)
        if found is None:
            found = hashlib.file_digest(file, "sha256").hexdigest()
            if time.time() - now.st_mtime > SETTLED_S:
                _known[of_file] = found
        return found


def is_plain(name: Name) -> bool:
    """Return whether a name is, or would be, a plain file: no device, no pipe, no /dev/stdout."""
    place = os.path.abspath(name)
    if place.startswith(("/dev/", "/proc/")) and not place.startswith("/dev/shm/"):  # plain memory
        return False
    try:
        return stat.S_ISREG(os.stat(name).st_mode)
    except OSError:
        return True


def is_named_pipe(name: Name) -> bool:
    """Return whether a name is that of a pipe in a folder: nobody may ever write to it.

    Those that a shell opens lie in /dev.
    """
    if os.path.abspath(name).startswith(("/dev/", "/proc/")):
        return False
    try:
        return stat.S_ISFIFO(os.stat(name).st_mode)
    except OSError:
        return False


def looked_for(name: Name) -> None:
    """Tell who watches files of one that is not there: of those that are opened, Python tells.

    Whoever finds out by other means than opening it calls this, so that it is seen to come.
    """
    sys.audit(LOOKED_FOR, os.fspath(name))


def named_from_folder(path: Name, folder: Name = os.curdir) -> str:
    """Return how a path is named from a folder; in full where it lies on another drive."""
    try:
        return os.path.relpath(path, folder)
    except ValueError:
        return os.path.abspath(path)


def not_a_path(name: str) -> str:
    """Return why a name that a person gave is no path of a file, as a sentence's end; or ""."""
    if re.match(r"[a-z][a-z0-9+.-]+:/", name, re.I):
        return "; it is an address, and only files of this machine are read: download it first"
    if name.startswith("~"):
        whole = os.path.expanduser(name)
        return f"; a shell puts the home folder in for ~ where it is not quoted: {whole}"
    if any(sign in name for sign in "*?["):
        return "; no file fits this pattern, or it is quoted: a shell then leaves it as it stands"
    return ""


def check_target(
    option: str, name: Name, endings: Sequence[str] = (), told_by_name: bool = False
) -> None:
    """Refuse a file that could not be written in the end, before the work.

    Parameters
    ----------
    option : str
        That names it on the command line, for the message.
    name : path
    endings : sequence of str, optional
        Those that a file of its format has, as ``.json``: a file of another kind is not written
        over by mistake. Pipes and devices may have any name.
    told_by_name : bool, optional
        Whether the name tells which of several formats is written, or those of other files: pipes
        and devices then need an ending, too.

    Raises
    ------
    UsageError
    """
    path = Path(name)
    folder = path.parent
    if not folder.is_dir():
        raise UsageError(f"{option} {name}: there is no folder {str(folder)!r}")
    if path.is_dir():
        raise UsageError(f"{option} {name}: is a folder; name a file in it")
    if endings and path.suffix.lower() not in endings and (told_by_name or is_plain(name)):
        near = did_you_mean(path.suffix, endings) if path.suffix else ""
        raise UsageError(f"{option} {name}: its name must end in {', '.join(endings)}{near}")
    written = Path(os.path.realpath(path)).parent if is_plain(path) else path
    if not os.access(written, os.W_OK):
        raise UsageError(f"{option} {name}: no permission to write in {str(written)!r}")
