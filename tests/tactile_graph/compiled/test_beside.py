"""Another process prepares pipelines while this one compiles, and at no other time."""

from __future__ import annotations

import io
import subprocess
from collections.abc import Sequence
from pathlib import Path

import pytest

from tactile_graph.compiled import beside, prepared_beside
from tactile_graph.compiled import preparing as preparing_module
from tactile_graph.compiled.preparing import Line, preparing, told_by
from tactile_graph.plugins.registry import installed


class Started:
    """Notes what would have been started, and whether it was stopped."""

    def __init__(self) -> None:
        self.files: list[Sequence[str]] = []
        self.calls: list[str] = []

    def __call__(self, files: Sequence[str], plugins: str) -> Started:
        self.files.append(files)
        return self

    def terminate(self) -> None:
        self.calls.append("terminate")

    def wait(self) -> None:
        self.calls.append("wait")


@pytest.fixture
def started(monkeypatch: pytest.MonkeyPatch) -> Started:
    noted = Started()
    monkeypatch.setattr(beside, "_preparing_process", noted)
    monkeypatch.setattr(beside.os, "cpu_count", lambda: 2)
    return noted


@pytest.fixture
def pipeline(tmp_path: Path) -> str:
    file = tmp_path / "mine.yaml"
    file.touch()
    return str(file)


def compile_one(name: str = "fit") -> None:
    with preparing.of(name, 1):
        preparing.at(compile_one)


def test_none_is_started_when_nothing_is_compiled(started: Started, pipeline: str) -> None:
    with prepared_beside([pipeline]):
        pass
    compile_one()
    assert started.files == []


def test_the_first_kernel_starts_one_and_leaving_stops_it(started: Started, pipeline: str) -> None:
    with prepared_beside([pipeline, "<text>"]):
        compile_one()
        compile_one()
        assert started.calls == []
    assert (started.files, started.calls) == ([[pipeline]], ["terminate", "wait"])


def test_none_is_started_for_no_file_nor_on_one_processor(
    started: Started, pipeline: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    with prepared_beside(["<text>"]):
        compile_one()
    monkeypatch.setattr(beside.os, "cpu_count", lambda: 1)
    with prepared_beside([pipeline]):
        compile_one()
    assert started.files == []


@pytest.mark.usefixtures("started")
def test_the_line_names_what_is_prepared_meanwhile(
    pipeline: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(preparing_module, "WORTH_A_LINE_S", -1.0)
    said = io.StringIO()
    with told_by(Line(said)), prepared_beside([pipeline]):
        compile_one()
    assert said.getvalue().rstrip().endswith("; meanwhile mine")


def test_the_process_prepares(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    file = installed().load("pipelines", "contacts")
    process: subprocess.Popen[bytes] = beside._preparing_process([str(file)], "")
    assert process.wait() == 0
    assert [*tmp_path.rglob("*.nbc")]
