"""One holder at a time, among processes too, and a process that dies leaves the lock free."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import IO

import pytest

from tactile_graph import locks
from tactile_graph.locks import Lock, is_locked, locked

HOLDER = """
import sys
from tactile_graph.locks import Lock
lock = Lock(sys.argv[1])
print(lock.take(), flush=True)
sys.stdin.read()
"""


def test_one_holder_at_a_time(tmp_path: Path) -> None:
    first, second = Lock(tmp_path / "in" / "a.lock"), Lock(tmp_path / "in" / "a.lock")
    assert first.take()
    assert first.take()
    assert not second.take()
    first.release()
    first.release()
    assert second.take()
    assert (first.held, second.held) == (False, True)
    second.release()


def test_a_process_that_dies_leaves_it_free(tmp_path: Path) -> None:
    name = tmp_path / "a.lock"
    lock = Lock(name)
    with subprocess.Popen(
        [sys.executable, "-c", HOLDER, str(name)], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    ) as holder:
        assert holder.stdout is not None
        assert holder.stdout.readline().strip() == b"True"
        assert not lock.take()
        holder.kill()
    assert lock.take()
    lock.release()


def test_whether_a_file_is_locked_is_told_without_making_or_keeping_it(tmp_path: Path) -> None:
    name = tmp_path / "a.lock"
    assert not is_locked(name)
    assert not name.exists()
    with name.open("wb") as file:
        assert locked(file)
        assert is_locked(name)
    assert not is_locked(name)
    lock = Lock(name)
    assert lock.take()
    lock.release()


def test_a_lock_that_is_removed_while_another_takes_it_has_one_holder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    name = tmp_path / "a.lock"
    first, second, third = (Lock(name) for _ in range(3))
    assert first.take()
    real = locks.locked

    def late(file: IO[bytes]) -> bool:
        first.remove()  # between the opening of the file and its lock
        return real(file)

    monkeypatch.setattr(locks, "locked", late)
    assert second.take()
    assert not third.take()
    second.remove()
    assert not name.exists()


def test_a_lock_is_taken_where_an_open_file_is_numbered_otherwise(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    lock, other = Lock(tmp_path / "a.lock"), Lock(tmp_path / "a.lock")
    monkeypatch.setattr("os.path.samestat", lambda a, b: False)
    assert lock.take()
    assert not other.take()
    lock.release()
