"""Another process helps while this one compiles, and at no other time."""

from __future__ import annotations

import io
import subprocess
from typing import Any

import pytest
from click.testing import CliRunner

from tactile_graph.api.pipeline import Pipeline
from tactile_graph.cli import cli
from tactile_graph.compiled import Work, beside, prepared_beside
from tactile_graph.compiled import preparing as preparing_module
from tactile_graph.compiled.preparing import Line, preparing, told_by

MINE = Work(("mine.yaml",), settings=("a.b=1",))


class Started:
    """Notes what would have been started, and whether it was stopped."""

    def __init__(self) -> None:
        self.works: list[Work] = []
        self.calls: list[str] = []

    def __call__(self, work: Work) -> Started:
        self.works.append(work)
        return self

    def terminate(self) -> None:
        self.calls.append("terminate")

    def wait(self) -> None:
        self.calls.append("wait")


@pytest.fixture
def started(monkeypatch: pytest.MonkeyPatch) -> Started:
    noted = Started()
    monkeypatch.setattr(beside, "_process", noted)
    monkeypatch.setattr(beside.os, "cpu_count", lambda: 2)
    return noted


def compile_one(name: str = "fit") -> None:
    with preparing.of(name, 1):
        preparing.at(compile_one)


def test_none_is_started_when_nothing_is_compiled(started: Started) -> None:
    with prepared_beside(MINE):
        pass
    compile_one()
    assert started.works == []


def test_the_first_kernel_starts_one_and_leaving_stops_it(started: Started) -> None:
    with prepared_beside(MINE):
        compile_one()
        compile_one()
        assert started.calls == []
    assert (started.works, started.calls) == ([MINE], ["terminate", "wait"])


def test_none_is_started_for_no_pipeline_nor_on_one_processor(
    started: Started, monkeypatch: pytest.MonkeyPatch
) -> None:
    with prepared_beside(Work(())):
        compile_one()
    monkeypatch.setattr(beside.os, "cpu_count", lambda: 1)
    with prepared_beside(MINE):
        compile_one()
    assert started.works == []


@pytest.mark.usefixtures("started")
def test_the_line_says_that_another_helps(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(preparing_module, "WORTH_A_LINE_S", -1.0)
    said = io.StringIO()
    with told_by(Line(said)), prepared_beside(MINE):
        compile_one()
    assert said.getvalue().rstrip().endswith("; another process compiles what comes later")


@pytest.mark.slow
def test_the_process_runs_to_its_end() -> None:
    process: subprocess.Popen[bytes] = beside._process(Work(("contacts", "no such pipeline")))
    assert process.wait() == 0


def test_a_command_has_help_while_it_compiles(
    monkeypatch: pytest.MonkeyPatch, started: Started
) -> None:
    runner = Pipeline.runner

    def compiling(self: Pipeline, *args: Any) -> Any:
        compile_one()
        return runner(self, *args)

    monkeypatch.setattr(Pipeline, "runner", compiling)
    said = ["run", "circle-3", "--frames", "1", "--set", "footprint.level_v=0.02"]
    done = CliRunner().invoke(cli, said)
    assert done.exit_code == 0, done.output
    assert started.works == [Work(("circle-3",), settings=("footprint.level_v=0.02",))]
    assert started.calls == ["terminate", "wait"]
