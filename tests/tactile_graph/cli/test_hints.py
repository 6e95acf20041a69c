"""What the command line says to slips of the hand."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from helpers_cli import call
from tactile_graph.cli.group import Group, _spelled_alike

pytestmark = pytest.mark.usefixtures("hand_made")


@pytest.mark.parametrize(
    ("args", "message"),
    [
        (["discs"], "no command named 'discs'; a pipeline is run by 'cli run discs'"),
        (["x.yaml"], "a pipeline is run by 'cli run x.yaml'"),
        (["x.csv"], "a pipeline is run over recordings by 'cli run PIPELINE x.csv'"),
        (["x.csv", "discs"], "a pipeline is run over recordings by 'cli run discs x.csv'"),
        (["help", "run"], "no command named 'help'; it is an option: 'cli run --help'"),
        (["--seed", "3", "run"], "a command's options stand behind it: 'cli run --seed …'"),
        (["run", "-help"], "did you mean '--help'?"),
        (["run", "http://a.org/x.yaml"], "only files of this machine are read: download it first"),
        (["run", "~/x.yaml"], f"where it is not quoted: {Path('~/x.yaml').expanduser()}"),
        (["run", "*.yaml"], "no pipeline file '*.yaml'; no file fits this pattern"),
        (["run", "-"], "standard input is /dev/stdin"),
        (["run", "discs", "discs"], "'discs' is a pipeline, and no recording is called so"),
        (["run", "discs", "circle.crash=1"], "a setting is given by --set circle.crash=1"),
        (["run", "discs", "--frames", "9" * 30], "more frames than can be counted"),
        (["run", "discs", "--frames", f"{'9' * 30}:"], "more frames than can be counted"),
        (["check", "."], "'.' is a folder; name a file in it"),
    ],
)
def test_a_slip_is_answered_with_what_to_do(args: list[str], message: str) -> None:
    got = call(*args)
    assert got.exit_code == 2
    assert message in got.stdout + got.stderr


@pytest.mark.parametrize(
    ("word", "name", "alike"),
    [("tun", "tune", True), ("shcema", "schema", True), ("objects-list", "objects", True),
     ("thesis", "stress", False), ("guards", "pads", False), ("plot", "ports", False)],
)  # fmt: skip
def test_a_command_is_meant_only_by_what_is_spelled_nearly_so(
    word: str, name: str, alike: bool
) -> None:
    assert _spelled_alike(word, name) == alike


@pytest.mark.parametrize(
    ("word", "told"),
    [("thesis", "'again' is about 'thesis'"), ("figure", "'again' is about 'figures'"),
     ("bench", "there are: "), ("measure", "there are: "), ("name", "there are: ")],
)  # fmt: skip
def test_what_a_command_says_of_itself_counts_by_whole_words(
    monkeypatch: pytest.MonkeyPatch, word: str, told: str
) -> None:
    told_of = {"run": "List each feature of NAME.", "again": "Make figures of the thesis again."}
    monkeypatch.setattr(Group, "_offered", lambda self: [])
    got = CliRunner().invoke(Group("cli", built_in=told_of), [word])
    assert f"no command named {word!r}; {told}" in got.stderr


def test_a_pipelines_file_may_be_meant_by_a_name_and_the_other_way_round() -> None:
    Path("mine.yaml").write_text("")
    assert "did you mean the file 'mine.yaml'?" in call("run", "mine").stderr
    Path("discs.yaml").rename("mine.yaml")
    assert "there is a pipeline named 'discs'" in call("run", "discs.yaml").stderr


def test_a_folder_that_is_called_nearly_as_a_command_is_not_what_was_meant() -> None:
    Path("plugin").mkdir()
    Path("films").mkdir()
    assert "no command named 'plugin'; did you mean 'plugins'?" in call("plugin").stderr
    assert "run over recordings by 'cli run PIPELINE films'" in call("films").stderr


def test_a_condition_that_fails_is_told_by_its_words_not_by_a_place_in_no_file() -> None:
    guarded = "{step: load, in: frame, when: 1 / (l.total - l.total) > 1}"
    nodes = f"{{l: {{step: load, in: frame}}, c: {guarded}}}"
    Path("p.yaml").write_text(f"{{pipeline: p, nodes: {nodes}, outputs: [c]}}")
    got = call("run", "p.yaml", "--source", "made")
    assert got.exit_code == 1
    told = "ZeroDivisionError: float division by zero (when 1 / (l.total - l.total) > 1)\n"
    assert told in got.stdout


def test_ctrl_c_while_the_program_is_still_being_imported_leaves_no_traceback() -> None:
    code = """\
import builtins, sys
real = builtins.__import__
def interrupted(name, *args, **kwargs):
    if name == "tactile_graph.cli.app":
        raise KeyboardInterrupt
    return real(name, *args, **kwargs)
builtins.__import__ = interrupted
from tactile_graph.cli import main
main()
"""
    got = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert (got.returncode, got.stderr) == (130, "interrupted\n")
