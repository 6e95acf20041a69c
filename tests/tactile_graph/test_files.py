"""Files are there whole or not at all, whatever they are written to."""

from __future__ import annotations

import hashlib
import os
import resource
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from tactile_graph.errors import UsageError
from tactile_graph.files import (
    check_target,
    is_plain,
    sha256_of,
    uninterrupted,
    whole_file,
    whole_folder,
    write_whole,
)


@contextmanager
def full_at_4096() -> Iterator[None]:
    """No file can be larger than 4096 bytes, as if the disc were full then: not even a log."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (4096, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


def test_a_full_disc_leaves_the_old_file_and_nothing_beside_it(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    write_whole(path, "old")
    too_large = pytest.raises(UsageError, match=r"a\.txt: cannot be written: File too large")
    with too_large, full_at_4096():
        write_whole(path, "x" * 5000)
    assert path.read_text() == "old"
    assert os.listdir(tmp_path) == ["a.txt"]


def test_an_error_on_the_way_leaves_nothing_behind(tmp_path: Path) -> None:
    def interrupted() -> None:
        with whole_file(tmp_path / "a.txt") as file:
            file.write(b"half")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert os.listdir(tmp_path) == []


def test_a_text_is_utf_8_and_keeps_its_line_ends(tmp_path: Path) -> None:
    write_whole(tmp_path / "a.txt", "größe\n")
    assert (tmp_path / "a.txt").read_bytes() == b"gr\xc3\xb6\xc3\x9fe\n"


def test_a_link_stays_a_link_and_what_it_points_to_is_replaced(tmp_path: Path) -> None:
    (tmp_path / "there").mkdir()
    (tmp_path / "link").symlink_to("there/a.txt")
    write_whole(tmp_path / "link", "new")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "there" / "a.txt").read_text() == "new"


def test_a_replaced_file_keeps_who_may_read_it(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    path.touch(0o600)
    write_whole(path, "new")
    assert path.stat().st_mode & 0o777 == 0o600


def test_a_pipe_is_written_to_and_stays_a_pipe(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    got: list[str] = []
    reader = threading.Thread(target=lambda: got.append(pipe.read_text()))
    reader.start()
    write_whole(pipe, "through")
    reader.join(10.0)
    assert got == ["through"]
    assert pipe.is_fifo()


def test_a_device_is_written_to_and_what_it_refuses_is_said(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def replace(part: Path, target: Path) -> None:
        raise AssertionError(f"{target} would be gone")

    monkeypatch.setattr(os, "replace", replace)  # root could really do it
    with pytest.raises(UsageError, match="/dev/full: cannot be written: No space left on device"):
        write_whole("/dev/full", "x")
    write_whole("/dev/null", "x")


def test_whoever_reads_the_older_file_reads_all_of_it(tmp_path: Path) -> None:
    """It is replaced, not written over: a kill at any moment leaves one of the two."""
    path = tmp_path / "a.txt"
    write_whole(path, "older")
    with path.open() as older:
        write_whole(path, "new")
        assert older.read() == "older"
    assert path.read_text() == "new"


def test_what_is_plain(tmp_path: Path) -> None:
    (tmp_path / "dangling").symlink_to("nowhere")
    assert is_plain(tmp_path / "new")
    assert is_plain(tmp_path / "dangling")
    assert is_plain("/dev/shm/new")
    assert not is_plain("/dev/stdout")
    assert not is_plain("/dev/null")
    assert not is_plain(tmp_path)


def test_what_cannot_be_written_is_refused_before_the_work(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    check_target("-o", "new.csv")
    check_target("-o", "/dev/null")
    with pytest.raises(UsageError, match=r"^-o no/a\.csv: there is no folder 'no'$"):
        check_target("-o", "no/a.csv")
    with pytest.raises(UsageError, match=r"^-o \.: is a folder; name a file in it$"):
        check_target("-o", ".")
    monkeypatch.setattr(os, "access", lambda *_: False)  # root may write anywhere
    with pytest.raises(UsageError, match=r"^--plot a\.png: no permission to write in '.*'$"):
        check_target("--plot", "a.png")


def test_a_signal_waits_for_the_end_of_what_only_all_of_it_undoes() -> None:
    done = []
    before = signal.getsignal(signal.SIGINT)

    def work() -> None:
        with uninterrupted():
            signal.raise_signal(signal.SIGINT)
            done.append("the rest")

    with pytest.raises(KeyboardInterrupt):
        work()
    assert done == ["the rest"]
    assert signal.getsignal(signal.SIGINT) is before
    with pytest.raises(KeyboardInterrupt):
        signal.raise_signal(signal.SIGINT)


def test_where_only_the_first_signal_waits_the_next_one_acts_at_once() -> None:
    done = []

    def work() -> None:
        with uninterrupted(once=True) as waiting:
            signal.raise_signal(signal.SIGINT)
            done.extend(waiting)
            signal.raise_signal(signal.SIGINT)
            done.append(0)

    with pytest.raises(KeyboardInterrupt):
        work()
    assert done == [signal.SIGINT]


def test_in_another_thread_nothing_waits() -> None:
    done = []

    def work() -> None:
        with uninterrupted():
            done.append(signal.getsignal(signal.SIGINT))

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert done == [signal.getsignal(signal.SIGINT)]


def test_a_digest_is_of_what_the_file_holds_now(tmp_path: Path) -> None:
    path = tmp_path / "a"
    path.write_bytes(b"first")
    long_ago = path.stat().st_mtime - 3600.0
    os.utime(path, (long_ago, long_ago))
    assert sha256_of(path) == sha256_of(path) == hashlib.sha256(b"first").hexdigest()
    path.write_bytes(b"other")  # as long as before
    assert sha256_of(path) == hashlib.sha256(b"other").hexdigest()
    path.write_bytes(b"third")  # at once: the time of change may be the same
    assert sha256_of(path) == hashlib.sha256(b"third").hexdigest()


def test_a_file_that_has_not_changed_is_not_read_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "a"
    path.write_bytes(b"first")
    long_ago = path.stat().st_mtime - 3600.0
    os.utime(path, (long_ago, long_ago))
    known = sha256_of(path)
    monkeypatch.delattr(hashlib, "file_digest")
    assert sha256_of(path) == known


def test_a_folder_gets_its_name_at_the_end_or_is_not_there(tmp_path: Path) -> None:
    target = tmp_path / "set"

    def cut_short() -> None:
        with whole_folder(target) as made:
            made.mkdir()
            (made / "half").touch()
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        cut_short()
    assert os.listdir(tmp_path) == []
    with whole_folder(target) as made:
        made.mkdir()
        (made / "all").touch()
        assert not target.exists()
    assert [p.relative_to(tmp_path).as_posix() for p in tmp_path.rglob("*")] == ["set", "set/all"]
    told = "set is there already: it came to be meanwhile, and stays"
    with pytest.raises(UsageError, match=told), whole_folder(target) as made:
        made.mkdir()
    assert os.listdir(tmp_path) == ["set"]
