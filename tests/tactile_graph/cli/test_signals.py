"""Commands as processes: what ends them leaves what was done, and closed streams are told."""

from __future__ import annotations

import array
import json
import os
import select
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

if sys.platform != "win32":
    import fcntl
    import termios

ENV = {**os.environ, "TACTILE_GRAPH_KERNELS": "plain"}
ENDLESS = ("circle-1", "--source", "simulate", "--frames", "1000000")
posix = pytest.mark.skipif(sys.platform == "win32", reason="signals as POSIX has them")


def process(*args: str, **streams: object) -> subprocess.Popen[bytes]:
    command = [sys.executable, "-m", "tactile_graph", *args]
    return subprocess.Popen(command, env=ENV, stderr=subprocess.PIPE, **streams)  # type: ignore[call-overload]


@pytest.mark.slow
@posix
@pytest.mark.parametrize("name", ["SIGTERM", "SIGHUP"])
def test_a_run_that_a_signal_ends_leaves_whole_lines_and_says_so(tmp_path: Path, name: str) -> None:
    out = tmp_path / "out.jsonl"
    running = process("run", *ENDLESS, "-o", str(out))
    end = time.monotonic() + 60
    while time.monotonic() < end and (not out.exists() or out.stat().st_size < 2000):
        time.sleep(0.05)
    number = signal.Signals[name]
    running.send_signal(number)
    _, said = running.communicate(timeout=60)
    assert running.returncode == 128 + number, said
    lines = out.read_text().splitlines(keepends=True)
    assert all(json.loads(line) for line in lines)
    assert lines[-1].endswith("\n")
    assert f"ended by {name}: {len(lines)} frames".encode() in said
    assert json.loads(Path(f"{out}.meta.json").read_text())["complete"] is False


@pytest.mark.slow
@posix
@pytest.mark.parametrize("workers", [(), ("--workers", "2")], ids=["one process", "workers"])
@pytest.mark.parametrize("n_read", [None, 0, 100], ids=["nobody", "not yet", "not to the end"])
def test_a_signal_ends_a_run_whose_pipe_nobody_reads(
    tmp_path: Path, n_read: int | None, workers: tuple[str, ...]
) -> None:
    pipe = tmp_path / "pipe.jsonl"
    os.mkfifo(pipe)
    reader = None if n_read is None else os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    running = process("run", *ENDLESS, "-o", str(pipe), *workers)
    if reader is not None:
        while not select.select([reader], [], [], 60)[0]:
            pass
        os.read(reader, n_read or 0)
    time.sleep(2.0)  # the pipe is full then
    running.send_signal(signal.SIGTERM)
    _, said = running.communicate(timeout=60)
    assert running.returncode == 128 + signal.SIGTERM, said
    assert b"ended by SIGTERM" in said
    if reader is not None:
        os.close(reader)


def await_full(pipe: int) -> None:
    """Wait until nothing more goes into a pipe."""
    n_before, n_bytes = -1, 0
    while n_bytes < 30_000 or n_bytes > n_before:
        time.sleep(1.0)
        waiting = array.array("i", [0])
        fcntl.ioctl(pipe, termios.FIONREAD, waiting)
        n_before, n_bytes = n_bytes, waiting[0]


@pytest.mark.slow
@posix
@pytest.mark.parametrize("output", ["pipe.jsonl", "-"])
def test_workers_end_with_the_line_that_they_count_last_where_a_pipe_is_read_slowly(
    tmp_path: Path, output: str
) -> None:
    named = output != "-"
    if named:
        output = str(tmp_path / output)
        os.mkfifo(output)
    running = process("run", *ENDLESS, "-o", output, "--workers", "2", stdout=subprocess.PIPE)
    with running:
        assert running.stdout is not None
        assert running.stderr is not None
        with open(output, "rb", buffering=0) if named else running.stdout as reader:
            got = os.read(reader.fileno(), 1)
            await_full(reader.fileno())
            running.send_signal(signal.SIGINT)
            time.sleep(0.2)  # or it is awake only when there is room again
            while part := os.read(reader.fileno(), 8000):
                got += part
                time.sleep(0.02)
        said = running.stderr.read()
    assert running.wait(60) == 130, said
    assert [json.loads(line)["frame"] for line in got.splitlines()] == [*range(got.count(b"\n"))]
    assert got.endswith(b"\n")
    assert b"interrupted: %d frames" % got.count(b"\n") in said


@pytest.mark.slow
@posix
def test_sigterm_keeps_what_was_compared_and_says_so(tmp_path: Path) -> None:
    pytest.importorskip("tactile_graph_compare")
    meant = tmp_path / "out.json"
    code = (
        "import os, sys, signal, pathlib\n"
        "from tactile_graph_compare.run.session import Session\n"
        "from tactile_graph.cli import main\n"
        "whole = Session.add\n"
        "def add(self, frame):\n"
        "    whole(self, frame)\n"
        "    if self.n == 12: os.kill(os.getpid(), signal.SIGTERM)\n"
        "Session.add = add\n"
        "main()\n"
    )
    source = ("--source", "simulate", "--frames", "30")
    words = ("compare", "circle-1", "circle-2", *source, "--json", str(meant))
    got = subprocess.run(
        [sys.executable, "-c", code, *words], env=ENV, capture_output=True, timeout=120, check=False
    )
    assert got.returncode == 128 + signal.SIGTERM, got.stderr
    assert b"ended by SIGTERM after 12 frames" in got.stdout
    data = json.loads(meant.read_text())
    assert (data["complete"], data["frames"]["n"]) == (False, 12)


@pytest.mark.slow
@posix
def test_a_signal_that_is_ignored_stays_so(tmp_path: Path) -> None:
    """What nohup starts goes on when its terminal is closed."""
    out = tmp_path / "out.jsonl"
    words = ("run", "circle-1", "--frames", "3", "-o", str(out))
    code = (
        "import os, signal, sys\n"
        "signal.signal(signal.SIGHUP, signal.SIG_IGN)\n"
        "from tactile_graph.cli import interrupt, main\n"
        "enter = interrupt.Interrupts.__enter__\n"
        "def entered(self):\n"
        "    enter(self); os.kill(os.getpid(), signal.SIGHUP); return self\n"
        "interrupt.Interrupts.__enter__ = entered\n"
        "main()\n"
    )
    got = subprocess.run([sys.executable, "-c", code, *words], env=ENV, check=False, timeout=120)
    assert got.returncode == 0
    assert len(out.read_text().splitlines()) == 3


def closed(stream: str, *words: str) -> subprocess.CompletedProcess[bytes]:
    command = ["sh", "-c", f'exec "$@" {stream}', "sh", sys.executable, "-m", "tactile_graph"]
    return subprocess.run([*command, *words], env=ENV, capture_output=True, timeout=60, check=False)


@posix
def test_a_closed_standard_output_is_refused_before_the_work(tmp_path: Path) -> None:
    """Whatever is opened next would take its number, and what is printed with it."""
    got = closed(">&-", "run", "circle-1", "--frames", "2", "-o", str(tmp_path / "a.csv"))
    told = b"error: standard output is closed (>&-); send it to /dev/null instead\n"
    assert (got.returncode, got.stderr) == (2, told)
    assert not (tmp_path / "a.csv").exists()


@pytest.mark.slow
@posix
@pytest.mark.parametrize(
    ("stream", "more"), [("2>&-", ()), ("<&-", ()), ("2>&- <&-", ("--workers", "2"))]
)
def test_other_streams_may_be_closed(tmp_path: Path, stream: str, more: tuple[str, ...]) -> None:
    """Processes that share work begin with the lowest numbers that are free."""
    out = tmp_path / "a.jsonl"
    got = closed(stream, "run", "circle-1", "--frames", "2", "-o", str(out), *more)
    assert got.returncode == 0, got.stderr
    assert [json.loads(line)["frame"] for line in out.read_text().splitlines()] == [0, 1]


@pytest.mark.slow
@posix
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="Linux has it")
@pytest.mark.parametrize(("words", "code"), [(("frobnicate",), 2), (("convert", "{a}", "{b}"), 0)])
def test_a_standard_error_without_room_changes_no_exit_code(
    tmp_path: Path, words: tuple[str, ...], code: int
) -> None:
    (tmp_path / "a.csv").write_text("".join(f"{k},2,3,5,{k}\n" * 9 for k in range(9)))
    told = (word.format(a=tmp_path / "a.csv", b=tmp_path / "b.npz") for word in words)
    got = closed("2>/dev/full", *told, *(() if code else ("--rows", "1", "--columns", "5")))
    assert (got.returncode, (tmp_path / "b.npz").exists()) == (code, not code)
