"""Processes that may die at any moment: what they were at is told at once, the others work on."""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from concurrent.futures import CancelledError
from multiprocessing import get_all_start_methods, get_context
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

import pytest

from helpers_workers import (
    Sealed,
    die,
    failed,
    killed_while_it_answers,
    leaves_a_folder,
    nothing,
    own_process,
    sealed,
    slowly,
    unreadable,
)
from tactile_graph.many.processes import opened
from tactile_graph.many.worker_processes import (
    DeadWorkerError,
    RaisedThereError,
    WorkerProcesses,
)

METHOD = "forkserver" if "forkserver" in get_all_start_methods() else "spawn"
PATIENCE_S = 60.0


@pytest.fixture
def workers() -> Iterator[WorkerProcesses]:
    made = WorkerProcesses(2, get_context(METHOD), nothing)
    yield made
    made.kill()


def test_work_is_shared(workers: WorkerProcesses) -> None:
    at = [workers.submit(slowly, 0.2) for _ in range(6)]
    found = {future.result(PATIENCE_S) for future in at}
    assert len(found) == 2
    assert os.getpid() not in found


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="SIGKILL")
def test_one_that_dies_over_half_an_answer_is_told_and_another_is_started(
    workers: WorkerProcesses,
) -> None:
    dead = workers.submit(killed_while_it_answers)
    rest = [workers.submit(own_process) for _ in range(4)]
    with pytest.raises(DeadWorkerError, match="a worker ended by SIGKILL"):
        dead.result(PATIENCE_S)
    assert all(future.result(PATIENCE_S) for future in rest)
    at = [workers.submit(slowly, 0.2) for _ in range(4)]
    assert len({future.result(PATIENCE_S) for future in at}) == 2


@pytest.mark.skipif(not hasattr(signal, "SIGRTMIN"), reason="real-time signals")
def test_one_that_a_signal_without_a_name_ends_is_told_with_its_number(
    workers: WorkerProcesses,
) -> None:
    dead = workers.submit(signal.raise_signal, signal.SIGRTMIN + 3)
    with pytest.raises(DeadWorkerError, match="a worker ended by signal"):
        dead.result(PATIENCE_S)


def test_one_that_dies_is_told_with_its_code(workers: WorkerProcesses) -> None:
    with pytest.raises(DeadWorkerError, match="a worker ended with code"):
        workers.submit(die).result(PATIENCE_S)


@pytest.mark.slow
def test_an_error_is_raised_here_and_says_where_it_was(workers: WorkerProcesses) -> None:
    with pytest.raises(ValueError, match="7 is none") as raised:
        workers.submit(failed, 7).result(PATIENCE_S)
    assert isinstance(raised.value.__cause__, RaisedThereError)
    assert "in failed" in str(raised.value.__cause__)


@pytest.mark.slow
def test_what_cannot_be_sent_is_told_and_costs_no_worker(workers: WorkerProcesses) -> None:
    first = {workers.submit(slowly, 0.2) for _ in range(4)}
    processes = {future.result(PATIENCE_S) for future in first}
    with pytest.raises(pickle.PicklingError, match="sealed"):
        workers.submit(own_process, Sealed()).result(PATIENCE_S)
    with pytest.raises(TypeError, match="sealed"):
        workers.submit(sealed).result(PATIENCE_S)
    with pytest.raises(TypeError, match="two"):
        workers.submit(unreadable).result(PATIENCE_S)
    after = {workers.submit(slowly, 0.2) for _ in range(4)}
    assert {future.result(PATIENCE_S) for future in after} == processes


def test_a_process_that_cannot_be_started_is_told() -> None:
    def local(lifeline: Connection) -> None:
        """No function of a module: it cannot be sent."""

    with WorkerProcesses(1, get_context(METHOD), local) as workers:
        for _ in range(2):
            with pytest.raises(DeadWorkerError, match="local"):
                workers.submit(own_process).result(PATIENCE_S)


@pytest.mark.slow
def test_the_end_waits_for_what_was_given() -> None:
    with WorkerProcesses(1, get_context(METHOD), nothing) as workers:
        at = [workers.submit(slowly, 0.05) for _ in range(3)]
    assert all(future.done() and future.result() for future in at)
    with pytest.raises(RuntimeError, match="take no work"):
        workers.submit(own_process)


@pytest.mark.slow
def test_what_waits_can_be_cancelled() -> None:
    workers = WorkerProcesses(1, get_context(METHOD), nothing)
    at = [workers.submit(slowly, 0.5) for _ in range(5)]
    at[0].result(PATIENCE_S)
    assert at[4].cancel()
    workers.shutdown(cancel_futures=True)
    with pytest.raises(CancelledError):
        at[3].result(0)
    assert at[0].result(0)


@pytest.mark.skipif(sys.platform == "win32", reason="SIGKILL")
def test_the_end_comes_at_once_whatever_they_are_at() -> None:
    begun_s = time.monotonic()
    place = opened("", 2)
    at = [place.executor.submit(slowly, 1000.0) for _ in range(4)]
    time.sleep(0.5)
    place.end()
    with pytest.raises((DeadWorkerError, CancelledError)):
        at[0].result(PATIENCE_S)
    assert time.monotonic() - begun_s < PATIENCE_S


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="SIGKILL")
def test_what_workers_had_when_they_were_killed_goes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    place = opened("", 1)
    place.executor.submit(leaves_a_folder, 1000.0)
    until_s = time.monotonic() + PATIENCE_S
    while not list(tmp_path.glob("tactile-graph-*/*")):
        assert time.monotonic() < until_s
        time.sleep(0.05)
    place.end()
    assert not list(tmp_path.glob("tactile-graph-*"))


ENDING = """
from tests_of import slowly
from tactile_graph.many.processes import opened
at = opened("", 2).executor.submit(slowly, 1000.0)
import time; time.sleep(1.0)
"""


@pytest.mark.slow
def test_a_program_that_forgets_to_end_them_ends(tmp_path: Any) -> None:
    (tmp_path / "tests_of.py").write_text(
        "import time\ndef slowly(seconds):\n    time.sleep(seconds)\n"
    )
    (tmp_path / "program.py").write_text(
        f"if __name__ == '__main__':{ENDING}".replace("\n", "\n    ")
    )
    subprocess.run([sys.executable, "program.py"], cwd=tmp_path, check=True, timeout=PATIENCE_S)
