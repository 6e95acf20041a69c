from __future__ import annotations

import ctypes
import errno
import os
import signal
import subprocess
import sys
import threading
from pathlib import Path
from types import SimpleNamespace

import pytest

from tactile_graph import part_files
from tactile_graph.errors import UsageError
from tactile_graph.files import whole_file
from tactile_graph.part_files import part_of, put_in_place, put_over

KILLED = """
import os, signal, sys
from pathlib import Path
from tactile_graph.part_files import part_of
part = part_of(Path(sys.argv[1]))
part.mkdir() if sys.argv[2] == "folder" else part.touch()
os.kill(os.getpid(), signal.SIGKILL)
"""

killed = pytest.mark.skipif(os.name == "nt", reason="no process is killed so there")


def _killed(target: Path, kind: str) -> Path:
    ended = subprocess.run([sys.executable, "-c", KILLED, str(target), kind])
    assert ended.returncode == -signal.SIGKILL
    (part,) = target.parent.glob(".*.part")
    return part


def test_a_file_may_have_the_longest_name_that_there_is(tmp_path: Path) -> None:
    for end in ("a.svg", "b.svg"):
        with whole_file(tmp_path / f"{'µ' * 125}{end}") as file:
            file.write(end.encode())
    other = part_of(tmp_path / f"{'µ' * 125}b.svg")
    assert part_of(tmp_path / f"{'µ' * 125}a.svg") != other
    assert {path.read_text() for path in tmp_path.iterdir()} == {"a.svg", "b.svg"}


@killed
@pytest.mark.slow
@pytest.mark.parametrize("kind", ["file", "folder"])
def test_what_a_killed_process_left_of_a_file_goes_with_the_next(tmp_path: Path, kind: str) -> None:
    target = tmp_path / "a[1].h5"
    left = _killed(target, kind)
    with whole_file(target) as file:
        assert not left.exists()
        file.write(b"whole")
    assert [path.name for path in tmp_path.iterdir()] == [target.name]


@killed
@pytest.mark.slow
def test_another_files_parts_stay(tmp_path: Path) -> None:
    left = _killed(tmp_path / "b.h5", "file")
    part_of(tmp_path / "a.h5")
    assert left.exists()


@pytest.mark.parametrize("there", [True, False])
def test_what_was_being_replaced_when_a_process_was_killed_is_not_lost(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, there: bool
) -> None:
    monkeypatch.setattr(part_files, "_runs", lambda process: process == os.getpid())
    target = tmp_path / "a.zarr"
    left = part_of(target).name.replace(str(os.getpid()), "7")
    folder(tmp_path / left, "new")
    folder(tmp_path / f"{left}.old", "old")
    if there:  # it was killed as it removed the older one
        folder(target, "newer")
    part_of(tmp_path / "a")
    assert (tmp_path / left).exists()
    part_of(target)
    assert (target / "what").read_text() == ("newer" if there else "old")
    assert [p.name for p in tmp_path.iterdir()] == ["a.zarr"]


@pytest.mark.parametrize(
    ("handle", "error", "waited", "runs"),
    [(0, 87, None, False), (0, 5, None, True), (4, 0, 258, True), (4, 0, 0, False)],
    ids=["none", "not to be asked", "at work", "ended"],
)
def test_windows_is_asked_whether_a_process_runs_without_a_signal(
    monkeypatch: pytest.MonkeyPatch, handle: int, error: int, waited: int | None, runs: bool
) -> None:
    kernel = SimpleNamespace(
        OpenProcess=lambda rights, inherited, process: handle,
        WaitForSingleObject=lambda handle, ms: waited,
        CloseHandle=lambda handle: 1,
    )
    monkeypatch.setattr(sys, "platform", "win32")
    monkeypatch.setattr(os, "kill", None)
    monkeypatch.setattr(ctypes, "WinDLL", lambda name, use_last_error: kernel, raising=False)
    monkeypatch.setattr(ctypes, "get_last_error", lambda: error, raising=False)
    assert part_files._runs(7) is runs


def test_parts_of_those_that_live_of_other_machines_and_strange_names_stay(tmp_path: Path) -> None:
    own = part_of(tmp_path / "a.h5")
    machine = own.name.split(".")[-2].rpartition("-")[0]
    names = [
        own.name,
        f".a.h5.{machine}-{os.getppid()}.part",
        ".a.h5.0badcafe-999999999.part",  # of another machine
        ".a.h5.joined.part",
        f".a.h5.{machine}-.part",
    ]
    for name in names:
        (tmp_path / name).touch()
    assert part_of(tmp_path / "a.h5") == own
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(names)


# -- a file, or a folder, takes the place of an older one -----------------------------------------


def folder(path: Path, text: str) -> Path:
    path.mkdir()
    (path / "what").write_text(text)
    return path


@pytest.mark.parametrize("at_once", [True, False])
def test_a_folder_takes_the_place_of_another_and_nothing_is_left_beside_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, at_once: bool
) -> None:
    if not at_once:  # as where the system cannot exchange two names
        monkeypatch.setattr(part_files, "_exchanged", lambda one, other: False)
    part, target = folder(tmp_path / ".a.part", "new"), folder(tmp_path / "a", "old")
    put_in_place(part, target, target)
    assert (target / "what").read_text() == "new"
    assert [p.name for p in tmp_path.iterdir()] == ["a"]


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="other systems do not exchange two names")
def test_at_no_moment_is_there_no_folder_of_that_name(tmp_path: Path) -> None:
    target, over, missed = folder(tmp_path / "a", "0"), threading.Event(), 0

    def look() -> None:
        nonlocal missed
        while not over.is_set():
            missed += not target.exists()

    watcher = threading.Thread(target=look)
    watcher.start()
    for i in range(1, 400):
        put_in_place(folder(tmp_path / ".a.part", str(i)), target, target)
    over.set()
    watcher.join()
    assert (missed, (target / "what").read_text()) == (0, "399")


def refused(*paths: object) -> None:
    raise PermissionError(13, "Access is denied")


def test_a_folder_that_cannot_be_replaced_stays_and_the_new_one_lies_beside_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    rename = Path.rename
    monkeypatch.setattr(part_files, "_exchanged", lambda one, other: False)
    monkeypatch.setattr(
        Path, "rename", lambda self, to: refused() if self.suffix == ".part" else rename(self, to)
    )
    part, target = folder(tmp_path / ".a.part", "new"), folder(tmp_path / "a.zarr", "old")
    beside = tmp_path / f"a.new-{os.getpid()}.zarr"
    with pytest.raises(UsageError) as told:
        put_in_place(part, target, "a.zarr")
    why = "a.zarr: cannot be written: Access is denied; it lies whole in"
    assert str(told.value) == f"{why} {beside}"
    assert (target / "what").read_text() == "old"
    assert (beside / "what").read_text() == "new"
    assert sorted(tmp_path.iterdir()) == sorted([target, beside])


def test_a_disc_that_is_full_as_an_older_file_is_written_into_takes_neither(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    replace = os.replace

    def full(source: object, file: object) -> None:
        raise OSError(28, "No space left on device")

    (tmp_path / "a.csv").write_text("old")
    monkeypatch.setattr(
        os,
        "replace",
        lambda a, b: refused() if b.suffix == ".csv" and b.stem == "a" else replace(a, b),
    )
    monkeypatch.setattr(part_files.shutil, "copyfileobj", full)
    told = pytest.raises(UsageError, match=r"No space left on device; it lies whole in .*a\.new-")
    with told, whole_file(tmp_path / "a.csv") as file:
        file.write(b"new")
    assert (tmp_path / f"a.new-{os.getpid()}.csv").read_text() == "new"


@pytest.mark.parametrize("number", [errno.EACCES, errno.ENOSYS, errno.EXDEV])
def test_lines_are_written_into_an_older_file_that_cannot_be_replaced(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, number: int
) -> None:
    new, older = tmp_path / "a.unfinished.csv", tmp_path / "a.csv"
    new.write_text("new")
    older.write_text("older and longer")

    def not_it(part: Path, target: Path) -> None:
        raise OSError(number, os.strerror(number))

    monkeypatch.setattr(os, "replace", not_it)
    put_over(new, older)
    assert older.read_text() == "new"


def test_a_file_that_can_be_neither_replaced_nor_written_into_lies_beside_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As one that a program has open on Windows; whoever writes it throws nothing away."""
    target = tmp_path / "a.html"
    target.write_text("old")
    monkeypatch.setattr(os, "replace", refused)
    with whole_file(target) as file:
        file.write(b"new")
    assert target.read_text() == "new"
    assert list(tmp_path.iterdir()) == [target]
    beside = tmp_path / f"a.new-{os.getpid()}.html"
    opened = Path.open

    def not_it(self: Path, mode: str = "r", **how: object) -> object:
        return refused() if self == target and mode == "wb" else opened(self, mode, **how)

    monkeypatch.setattr(Path, "open", not_it)
    told = pytest.raises(UsageError, match=r"cannot be written: Access is denied; it lies whole in")
    with told, whole_file(target) as file:
        file.write(b"newer")
    assert (target.read_text(), beside.read_text()) == ("new", "newer")
