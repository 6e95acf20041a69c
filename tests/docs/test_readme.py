"""The README's commands, files and code do what it says."""

from __future__ import annotations

import re
import shlex
import sys
from pathlib import Path
from types import ModuleType

import pytest
from click.testing import CliRunner

from tactile_graph import load, loads
from tactile_graph.cli import cli
from tactile_graph.testing import check_step

ROOT = Path(__file__).parents[2]
README = ROOT / "README.md"
pytestmark = pytest.mark.skipif(not README.is_file(), reason="the README is not beside the tests")


def block(kind: str) -> str:
    found = re.search(rf"^```{kind}\n(.*?)^```", README.read_text(encoding="utf-8"), re.M | re.S)
    assert found is not None, kind
    return found.group(1)


def test_the_first_command_sets_up_and_locates_the_bundled_discs_and_draws_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    steps = block("sh run").strip().split(" && ")
    assert steps[:2] == ["python3 -m venv .venv", ".venv/bin/pip install -q ."]
    program, *arguments = shlex.split(steps[2])
    assert program == ".venv/bin/tactile-graph"
    monkeypatch.chdir(tmp_path)
    result = CliRunner().invoke(cli, arguments)
    assert result.exit_code == 0, result.output
    assert "6 with all outputs" in result.output
    assert (tmp_path / "strip.png").read_bytes().startswith(b"\x89PNG")


def test_commands_without_a_folder_stand_below_the_line_that_activates_theirs() -> None:
    text = README.read_text(encoding="utf-8")
    bare = min(found.start() for found in re.finditer(r"^(tactile-graph|pip|python) ", text, re.M))
    assert -1 < text.find("`. .venv/bin/activate`") < bare


def test_the_second_command_sets_up_and_runs_the_tests() -> None:
    steps = block("sh test").strip().split(" && ")
    assert steps == [
        "python3 -m venv .venv",
        ".venv/bin/pip install -q --no-compile -e '.[test]'",
        ".venv/bin/pytest",
    ]


def test_the_pipeline_shown_is_the_one_shipped() -> None:
    assert block("yaml") == load("circle-3").text
    assert loads(block("yaml")).key == load("circle-3").key


def test_the_python_shown_runs(capsys: pytest.CaptureFixture[str]) -> None:
    for code in re.findall(r"^```python\n(.*?)^```", README.read_text("utf-8"), re.M | re.S):
        exec(compile(code, "README.md", "exec"), {"__name__": "readme"})
    assert "FittedCircle" in capsys.readouterr().out


def test_the_step_shown_keeps_the_promises_of_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    shown = ModuleType("readme")
    monkeypatch.setitem(sys.modules, "readme", shown)
    exec(compile(block("python"), "README.md", "exec"), vars(shown))
    check_step(shown.brighter)
