"""One run at a time writes a file of lines, and leaves nothing else beside it."""

from __future__ import annotations

import errno
import json
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from helpers_cli import call
from tactile_graph.cli.many.unfinished import Unfinished
from tactile_graph.cli.output.one_run import opened_alone
from tactile_graph.errors import UsageError

OF = {"pipeline": "p"}
REFUSED = "-o {}: another run is writing it, or another program has locked it"


@pytest.mark.usefixtures("hand_made")
@pytest.mark.parametrize("name", ["out.jsonl", "out.csv"])
def test_a_file_that_another_run_writes_is_refused_and_stays(tmp_path: Path, name: str) -> None:
    with opened_alone(name) as file:
        file.write(b"theirs\n")
        got = call("run", "discs", "-o", name)
        assert got.exit_code == 2
        assert got.stderr == f"error: {REFUSED.format(name)}\n"
        without_frames = call("run", "discs", "--with", "frames=0", "-o", name)
        assert REFUSED.format(name) in without_frames.stderr
    assert (tmp_path / name).read_bytes() == b"theirs\n"
    assert not (tmp_path / f"{name}.meta.json").exists()
    assert call("run", "discs", "-o", name).exit_code == 0
    assert call("run", "discs", "-o", name).exit_code == 0
    assert {p.name for p in tmp_path.glob("*out*")} == {name, f"{name}.meta.json"}
    assert len((tmp_path / name).read_text().splitlines()) == 4 + (name == "out.csv")


@pytest.mark.usefixtures("hand_made")
def test_another_name_of_the_same_file_is_refused_too(tmp_path: Path) -> None:
    (tmp_path / "link.jsonl").symlink_to("out.jsonl")
    with opened_alone("out.jsonl"):
        got = call("run", "discs", "-o", "link.jsonl")
    assert REFUSED.format("link.jsonl") in got.stderr


@pytest.mark.usefixtures("hand_made")
def test_one_process_and_workers_refuse_each_other(tmp_path: Path) -> None:
    workers = Unfinished("out.jsonl")
    workers.begin(OF)
    got = call("run", "discs", "-o", "out.jsonl")
    assert (got.exit_code, got.stderr) == (2, f"error: {REFUSED.format('out.jsonl')}\n")
    assert not (tmp_path / "out.jsonl").exists()
    workers.remove()
    with opened_alone("out.jsonl"):
        with pytest.raises(UsageError, match="another run is writing it"):
            workers.begin(OF)
        assert [p.name for p in tmp_path.glob("*out*")] == ["out.jsonl"]
        assert [*tmp_path.glob(".out*")] == []
    workers.begin(OF)
    workers.remove()


def test_what_a_run_with_workers_left_is_gone_on_with_after_one_process_wrote(
    tmp_path: Path,
) -> None:
    output = str(tmp_path / "out.jsonl")
    left = Unfinished(output)
    left.begin(OF)
    left.add(3, b"x\n", {})
    left.close()
    with opened_alone(output), pytest.raises(UsageError, match="another run is writing it"):
        Unfinished(output).read()
    again = Unfinished(output)
    assert again.read() == OF
    assert again.high == 3
    again.close()


def test_of_two_that_begin_at_once_one_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    output = str(tmp_path / "out.jsonl")
    workers = Unfinished(output)
    looked = []

    def beginning(name: object, at: int = 0) -> bool:
        looked.append(name)
        if len(looked) == 1:  # the workers begin between this look and the lock
            workers.begin(OF)
            return False
        return True

    monkeypatch.setattr("tactile_graph.cli.output.one_run.is_locked", beginning)
    monkeypatch.setattr("tactile_graph.cli.many.unfinished.refuse_if_written", lambda output: None)
    with pytest.raises(UsageError, match="another run is writing it"):
        opened_alone(output)
    workers.remove()


def test_a_file_system_without_locks_is_written_all_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def no_locks(file: object, at: int) -> None:
        raise OSError(errno.ENOLCK, "No locks available")

    monkeypatch.setattr("tactile_graph.locks._lock", no_locks)
    with opened_alone(str(tmp_path / "out.csv")) as file:
        file.write(b"a\n")
    assert (tmp_path / "out.csv").read_bytes() == b"a\n"


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no named pipes")
def test_a_pipe_is_written_by_whoever_opens_it(tmp_path: Path) -> None:
    pipe = str(tmp_path / "pipe")
    os.mkfifo(pipe)
    came: list[bytes] = []
    reader = threading.Thread(target=lambda: came.append(Path(pipe).read_bytes()))
    reader.start()
    with opened_alone(pipe) as one, opened_alone(pipe) as other:
        one.write(b"1")
        other.write(b"2")
    reader.join()
    assert sorted(came[0]) == sorted(b"12")


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="sends POSIX's signals")
def test_a_run_that_is_killed_leaves_its_file_alone_and_free(tmp_path: Path) -> None:
    words = [
        sys.executable, "-m", "tactile_graph", "run", "circle-3", "--source", "simulate",
        "--with", "scene=discs", "--frames",
    ]  # fmt: skip
    with subprocess.Popen([*words, "1000000", "-o", "out.jsonl"], cwd=tmp_path) as first:
        try:
            while not (tmp_path / "out.jsonl.meta.json").exists():
                assert first.poll() is None
                time.sleep(0.05)
            second = subprocess.run(
                [*words, "3", "-o", "out.jsonl"], cwd=tmp_path, capture_output=True, text=True,
                check=False,
            )  # fmt: skip
        finally:  # a failure, too, waits for its end
            first.send_signal(signal.SIGKILL)
    assert (second.returncode, second.stderr.splitlines()[-1]) == (
        2, f"error: {REFUSED.format('out.jsonl')}",
    )  # fmt: skip
    assert {p.name for p in tmp_path.iterdir()} == {"out.jsonl", "out.jsonl.meta.json"}
    lines = (tmp_path / "out.jsonl").read_text().splitlines()
    assert [json.loads(line)["frame"] for line in lines[:-1]] == [*range(len(lines) - 1)]
    again = subprocess.run([*words, "3", "-o", "out.jsonl"], cwd=tmp_path, check=False)
    assert again.returncode == 0
    assert len((tmp_path / "out.jsonl").read_text().splitlines()) == 3
