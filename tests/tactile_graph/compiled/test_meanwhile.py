"""Plain code answers while another process compiles; then machine code does."""

from __future__ import annotations

import io
import os
import pickle
import re
import subprocess
import sys
from base64 import b64decode
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tactile_graph.compiled import answered_meanwhile, compiled_as_is, compiled_later, meanwhile
from tactile_graph.compiled import kernel as kernels
from tactile_graph.compiled.kernel import Kernel
from tactile_graph.compiled.preparing import Line, preparing, told_by
from tactile_graph.compiled.service import serve


@compiled_as_is
def inner(x: Any) -> float:
    """Return a sum by a loop."""
    total = 0.0
    for k in range(x.shape[0]):
        total += x[k]
    return total


@compiled_as_is
def outer(x: Any) -> tuple[float, int]:
    """Call another kernel."""
    return inner(x) + 1.0, x.shape[0]


class Pipe(io.BytesIO):
    """A pipe whose lines stay readable when it is closed."""

    def __init__(self) -> None:
        super().__init__()
        self.lines: list[bytes] = []

    def write(self, line: Any) -> int:
        self.lines.append(bytes(line))
        return len(line)


class Process:
    """Stands for the other process: keeps what it is asked, works until told otherwise."""

    def __init__(self) -> None:
        self.stdin = Pipe()
        self.pid, self.returncode, self.ended = 4711, None, False
        self.calls: list[str] = []

    def poll(self) -> int | None:
        return 0 if self.ended else None

    def terminate(self) -> None:
        self.calls.append("terminate")

    def wait(self) -> None:
        self.ended = True


class World:
    """What is on disk, who compiled here, and the process."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.on_disk = False
        self.compiled_here: list[str] = []
        self.process = Process()
        self.started = 0
        monkeypatch.delenv("TACTILE_GRAPH_KERNELS", raising=False)
        monkeypatch.setattr(meanwhile.os, "cpu_count", lambda: 2)
        monkeypatch.setattr(meanwhile, "_process", self._start)
        monkeypatch.setattr(meanwhile, "LOOK_S", 0.0)
        monkeypatch.setattr(meanwhile.Call, "on_disk", lambda call: self.on_disk)
        monkeypatch.setattr(Kernel, "compiled", property(self._compiled))

    def _start(self) -> Process:
        self.started += 1
        return self.process

    def _compiled(self, kernel: Kernel[Any, Any]) -> Any:
        def run(*args: Any) -> Any:
            if not kernels._running.plain_loops:  # not one within another
                self.compiled_here.append(kernel.__name__)
            kernels._running.plain_loops = True
            try:
                return kernel.loops(*args)
            finally:
                kernels._running.plain_loops = False

        return run

    @property
    def asked(self) -> list[tuple[str, str]]:
        return [pickle.loads(b64decode(line))[:2] for line in self.process.stdin.lines]


@pytest.fixture
def world(monkeypatch: pytest.MonkeyPatch) -> Iterator[World]:
    for kernel in (inner, outer):
        kernel.reset()
    yield World(monkeypatch)
    for kernel in (inner, outer):
        kernel.reset()


X = np.arange(4.0)


def test_plain_code_answers_and_asks_once_until_the_machine_code_is_there(world: World) -> None:
    with answered_meanwhile():
        assert outer.call(X) == (7.0, 4)
        assert outer.call(X) == (7.0, 4)
        assert world.compiled_here == []
        world.on_disk = True
        assert outer.call(X) == (7.0, 4)
        assert world.compiled_here == ["outer"]
    assert world.asked == [(__name__, "outer")], "kernels within another are parts of it"
    assert world.started == 1


def test_what_is_on_disk_answers_at_once_and_starts_nothing(world: World) -> None:
    world.on_disk = True
    with answered_meanwhile():
        outer.call(X)
    assert (world.started, world.compiled_here) == (0, ["outer"])


def test_a_record_comes_back_with_python_s_own_numbers(world: World) -> None:
    with answered_meanwhile():
        total, _ = outer.call(X)
    assert type(total) is float


@pytest.mark.parametrize("why", ["large", "patience", "ended", "one processor", "plain", "outside"])
def test_it_is_compiled_here_or_answered_plainly_where_waiting_gains_nothing(
    why: str, world: World, monkeypatch: pytest.MonkeyPatch
) -> None:
    x, patience_s = X, meanwhile.PATIENCE_S
    if why == "large":
        x = np.zeros(meanwhile.MOST_ELEMENTS + 1)
    elif why == "patience":
        patience_s = -1.0
    elif why == "ended":
        world.process.ended = True
    elif why == "one processor":
        monkeypatch.setattr(meanwhile.os, "cpu_count", lambda: 1)
    elif why == "plain":
        monkeypatch.setenv("TACTILE_GRAPH_KERNELS", "plain")
        outer.reset()
    if why == "outside":
        with answered_meanwhile():
            outer.call(x)
        outer.call(x)
    else:
        with answered_meanwhile(patience_s=patience_s):
            outer.call(x)
    assert world.compiled_here == ([] if why == "plain" else ["outer"])


def test_a_run_that_ends_well_lets_the_process_finish_and_says_so(world: World) -> None:
    told: list[int] = []
    with answered_meanwhile(told.append):
        outer.call(X)
    assert (told, world.process.calls) == ([4711], [])
    assert world.process.stdin.closed, "its end of input: it finishes what it was asked, and ends"


def test_an_error_stops_the_process(world: World) -> None:
    told: list[int] = []

    def interrupted() -> None:
        with answered_meanwhile(told.append):
            outer.call(X)
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert (told, world.process.calls) == ([], ["terminate"])


def test_kernels_that_are_plain_at_first_keep_their_own_rule(world: World) -> None:
    later: Kernel[Any, Any] = compiled_later(inner.loops)
    with answered_meanwhile():
        for _ in range(201):
            later.call(X)
    assert world.asked == []
    assert world.compiled_here == ["inner"]


def test_those_within_plain_loops_are_not_compiled_here_however_often_they_are_called(
    world: World,
) -> None:
    later: Kernel[Any, Any] = compiled_later(inner.loops)

    @compiled_as_is
    def often(x: Any) -> float:
        total = 0.0
        for _ in range(300):
            total += later(x)
        return total

    with answered_meanwhile():
        assert often.call(X) == 1800.0
    assert world.compiled_here == []
    assert [name for _, name in world.asked] == [often.loops.__qualname__]


def test_one_is_told_who_compiles(world: World, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tactile_graph.compiled.preparing.WORTH_A_LINE_S", -1.0)
    said = io.StringIO()
    with told_by(Line(said)), answered_meanwhile():
        outer.call(X)
    assert said.getvalue().startswith("plain code answers while another process compiles outer")
    assert preparing.on_first is None


def test_the_service_leaves_out_what_it_cannot_import(monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[Any] = []
    monkeypatch.setattr(
        "tactile_graph.compiled.machine_code.make_ahead", lambda loops, types: made.append(loops)
    )
    lines = [
        meanwhile.b64encode(pickle.dumps(asked))
        for asked in [
            ("no.such.module", "f", ()),
            (__name__, "nothing", ()),
            (__name__, "inner", ()),
        ]
    ]
    serve(lines)
    assert made == [inner.loops]


@pytest.mark.slow
def test_an_empty_cache_answers_like_a_full_one_and_is_filled_behind_it(tmp_path: Path) -> None:
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)}
    environment.pop("TACTILE_GRAPH_KERNELS", None)
    command = [sys.executable, "-m", "tactile_graph", "run", "bayes-smooth", "--frames", "1"]
    command += ["-o", "-", "--format", "jsonl"]

    def run() -> subprocess.CompletedProcess[str]:
        return subprocess.run(command, env=environment, capture_output=True, text=True, check=True)

    first = run()
    process = int(re.search(r"process (\d+) still compiles", first.stderr)[1])  # type: ignore[index]
    while Path(f"/proc/{process}").exists():  # it works at most a minute
        subprocess.run(["sleep", "0.2"], check=True)
    second = run()
    assert "still compiles" not in second.stderr
    assert first.stdout == second.stdout
