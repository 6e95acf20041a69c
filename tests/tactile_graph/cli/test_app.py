"""The command itself: lazy commands, plugins' commands, and errors without tracebacks."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import types
from pathlib import Path

import pytest

from helpers_cli import broken_plugin, call, install
from tactile_graph.cli.app import COMMANDS
from tactile_graph.code_version import code_version
from tactile_graph.plugins import registry

COMMAND = '''
"""A plugin's module of commands."""
import click
from tactile_graph.errors import UsageError

@click.command()
@click.option("--fail", is_flag=True)
@click.option("--crash", is_flag=True)
def hello(fail, crash):
    """Say hello to the pad. And more."""
    if fail:
        raise UsageError("nobody there")
    if crash:
        raise KeyError("pad")
    click.echo("hello")
    return 5

@click.group()
def duo():
    """Do either."""

@duo.command()
def crash():
    """Crash."""
    raise KeyError("pad")

not_a_command = 3
'''
COMMAND_OF = {
    "hello": "tg_test_commands:hello",
    "gone": "tg_test_commands:gone",
    "lost": "tg_no_such_module:x",
    "number": "tg_test_commands:not_a_command",
    "run": "tg_test_commands:hello",
    "duo": "tg_test_commands:duo",
}


@pytest.fixture
def with_commands(hand_made: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (hand_made / "tg_test_commands.py").write_text(COMMAND)
    monkeypatch.syspath_prepend(str(hand_made))
    monkeypatch.delitem(sys.modules, "tg_test_commands", raising=False)
    install(monkeypatch, hand_made, commands=COMMAND_OF)


@pytest.mark.usefixtures("with_commands")
def test_help_lists_plugins_commands_with_their_first_sentence_without_importing_them():
    got = call("--help")
    assert got.exit_code == 0
    own, _, others = got.stdout.partition("Commands of plugins:")
    assert all(name in own for name in COMMANDS)
    assert "hello   Say hello to the pad.\n" in others
    assert "gone    (of plugin 'hand' (package hand-made))" in others
    assert "run " not in others
    assert "tg_test_commands" not in sys.modules


@pytest.mark.usefixtures("with_commands")
def test_a_plugins_command_runs_takes_the_shared_options_and_returns_no_exit_code():
    got = call("hello", "--plugins", "hand")
    assert got.exit_code == 0
    assert got.stdout == "hello\n"


@pytest.mark.usefixtures("with_commands")
@pytest.mark.parametrize(
    ("args", "message"),
    [
        (["hello", "--fail"], "error: nobody there\n"),
        (["hello", "--crash"], "error: KeyError: 'pad'\n(--debug shows where)"),
        (["hello", "--fial"], "--fial"),
        (["lost"], "'lost' of plugin 'hand' (package hand-made): cannot import tg_no_such_module"),
        (["gone"], "tg_test_commands has no 'gone'"),
        (
            ["number"],
            "command 'number' of plugin 'hand' (package hand-made) must be a click.Command",
        ),
        (["helo"], "no command named 'helo'; did you mean 'hello'?"),
        (["drawing"], "no command named 'drawing'; 'graph' is about 'draw'"),
        (["xyzzy"], "no command named 'xyzzy'; there are: check, duo, explain, gone,"),
        (["--plugins", "hnad", "run"], "--plugins: no plugin named 'hnad'; did you mean 'hand'?"),
        (["run", "--plugins", "hnad"], "--plugins: no plugin named 'hnad'; did you mean 'hand'?"),
    ],
)
def test_every_mistake_is_a_line_on_stderr_and_exit_code_2(args, message):
    got = call(*args)
    assert got.exit_code == 2
    assert message in got.stderr
    assert "Traceback" not in got.output


@pytest.mark.usefixtures("with_commands")
def test_an_unknown_plugin_in_the_environment_is_told_as_such(monkeypatch):
    monkeypatch.setattr(registry, "_override", None)
    monkeypatch.setenv("TACTILE_GRAPH_PLUGINS", "-hnad")
    told = "TACTILE_GRAPH_PLUGINS: no plugin named 'hnad'; did you mean 'hand'?"
    assert told in call("hello").stderr
    assert told not in call("--plugins", "hand", "hello").output


@pytest.mark.usefixtures("with_commands")
def test_a_plugins_bare_group_is_a_command_as_any():
    alone = call("duo")
    assert (alone.exit_code, alone.stdout) == (2, "")
    assert alone.stderr == call("duo", "--help").stdout
    assert "(--debug shows where)" in call("duo", "crash").stderr
    assert "Traceback" in call("duo", "crash", "--debug").stderr
    assert "did you mean 'hand'?" in call("duo", "crash", "--plugins", "hnad").stderr


def test_a_command_that_is_not_there_may_be_of_a_plugin_that_is_down(hand_made, monkeypatch):
    install(monkeypatch, hand_made, ("torn", "torn-package", "0.3", broken_plugin))
    told = "(plugins failed to load: torn; 'tactile-graph plugins' says why)"
    assert told in call("wobble").stderr
    assert "torn  No module named 'antigravity'" in call("--help").stdout


def test_without_a_command_the_help_says_what_there_is():
    result = call()
    assert result.exit_code == 2
    assert result.stderr.startswith("Usage: ")
    assert "inspect" in result.stderr
    assert not result.stdout
    assert "error" not in result.stderr.partition("Options:")[0]


def test_version():
    assert call("--version").stdout == f"tactile-graph, version {code_version()}\n"


@pytest.mark.parametrize("args", [["--help"], ["run", "--help"]])
@pytest.mark.usefixtures("hand_made")
def test_help_says_the_exit_codes(args):
    text = call(*args).stdout
    for code in (0, 1, 2, 130, 141):
        assert f"  {code:<4} " in text


@pytest.mark.usefixtures("hand_made")
def test_the_flag_goes_before_the_environment(monkeypatch):
    from tactile_graph.plugins import registry

    monkeypatch.setenv(registry.ENVIRONMENT, "-hand")
    registry.installed.cache_clear()
    assert "no pipeline named 'discs'" in call("run", "discs").stderr
    assert call("run", "discs", "--plugins", "hand").exit_code == 0


# -- plugins -------------------------------------------------------------------------------------


def test_plugins_lists_what_is_offered_broken_blocked_and_refused(hand_made, monkeypatch):
    from tactile_graph.plugins import registry

    twin = types.ModuleType("twin")
    from tactile_graph import hookimpl

    @hookimpl
    def tactile_graph_steps() -> dict[str, str]:
        return {"disc": "x:y", "other": "x:z"}

    twin.tactile_graph_steps = tactile_graph_steps  # type: ignore[attr-defined]
    more = (
        ("torn", "torn-package", "0.3", broken_plugin),
        ("twin", "twin-package", "2", lambda: twin),
        ("shut", "shut-package", "4", broken_plugin),
    )
    install(monkeypatch, hand_made, *more, commands={"run": "a:b"})
    monkeypatch.setenv(registry.ENVIRONMENT, "-shut")
    registry.installed.cache_clear()
    got = call("plugins")
    assert got.exit_code == 0
    cells = {line.split()[0]: line.split() for line in got.stdout.splitlines() if line.strip()}
    assert cells["hand"][1:3] == ["hand-made", "1.2"]
    assert cells["hand"][4:] == ["9", "steps,", "1", "reader,", "2", "pipelines,", "1", "command"]
    assert cells["torn"][4:] == ["failed", "to", "load,", "see", "below"]
    assert " ".join(cells["twin"][4:]) == "2 of its steps cannot be used, see below"
    assert "plugin 'twin' (package twin-package), step 'other': " in got.stdout
    assert "No module named 'x'" in got.stdout
    assert cells["shut"] == ["shut", "shut-package", "4", "blocked"]
    assert "plugin 'torn' (package torn-package): No module named 'antigravity'" in got.stdout
    assert (
        "clash: step 'disc' is ambiguous: plugin 'hand' (package hand-made) and plugin 'twin' "
        "(package twin-package) offer it; write hand.disc or twin.disc" in got.stdout
    )
    assert (
        "clash: command 'run' of plugin 'hand' (package hand-made) is refused: tactile-graph has "
        "its own" in got.stdout
    )


# -- pipelines -----------------------------------------------------------------------------------


def test_pipelines_are_listed_below_what_they_evolved_from(hand_made, monkeypatch):
    for name, text in {
        "third": "pipeline: third\nabout: The third\nevolves: loads\nnodes: {}\noutputs: []\n",
        "torn": "pipeline: [",
        "round": "pipeline: round\nabout: A loop\nevolves: round\nnodes: {a: {}}\noutputs: [a]\n",
    }.items():
        (hand_made / f"{name}.yaml").write_text(text)
    names = ("third", "torn", "round", "absent")
    more = {n: hand_made / f"{n}.yaml" for n in names}
    install(monkeypatch, hand_made, pipelines=more)
    got = call("pipelines")
    assert got.exit_code == 0
    lines = got.stdout.splitlines()
    at = lines.index(next(line for line in lines if line.startswith("discs ")))
    assert lines[at].split("  ")[0] == "discs"
    assert "A disc on hand-made frames" in lines[at]
    assert lines[at + 1].startswith("└─ loads")
    assert lines[at + 2].startswith("   └─ third")
    assert any(line.startswith("torn") and "this is not YAML" in line for line in lines)
    assert any(line.startswith("absent") and "cannot be read" in line for line in lines)
    assert sum(line.startswith("round") for line in lines) == 1


# -- check ---------------------------------------------------------------------------------------


@pytest.mark.usefixtures("hand_made")
def test_check_says_what_is_right_and_which_nodes_no_output_needs():
    got = call("check", "discs", "loads")
    assert got.exit_code == 0
    assert "discs: right  2 nodes → circle; takes frames from made\n" in got.stdout
    assert "loads: right  4 nodes → load, shape; declares no source; evolves discs" in got.stdout
    assert "no output needs: spare" in got.stdout


def test_check_reports_every_problem_of_every_file_and_exits_with_2(hand_made):
    from helpers_cli import DISCS

    bad = DISCS.replace("step: pressed", "step: presed").replace("outputs", "output")
    (hand_made / "bad.yaml").write_text(bad)
    got = call("check", "bad.yaml", "discs", "absent")
    assert got.exit_code == 2
    assert "bad.yaml: wrong" in got.stdout
    assert "bad.yaml:5:21: node 'footprint': no step named 'presed'" in got.stdout
    assert "unknown key 'output'; did you mean 'outputs'?" in got.stdout
    assert "discs: right" in got.stdout
    assert "no pipeline named 'absent'" in got.stdout


@pytest.mark.usefixtures("hand_made")
def test_check_without_names_checks_all_that_are_installed():
    got = call("check")
    assert got.exit_code == 0
    assert got.stdout.count(": right") == 2


# -- graph ---------------------------------------------------------------------------------------


@pytest.mark.usefixtures("hand_made")
@pytest.mark.parametrize(
    ("args", "start"),
    [
        ([], "flowchart LR"), (["--format", "mermaid"], "flowchart LR"),
        (["--format", "dot"], "digraph"), (["--format", "svg"], "<svg"),
    ],
)  # fmt: skip
def test_graphs_go_to_stdout(args, start):
    got = call("graph", "discs", *args)
    assert got.exit_code == 0
    assert start in got.stdout
    assert "footprint" in got.stdout


@pytest.mark.parametrize(
    ("name", "start"), [("g.svg", "<svg"), ("g.dot", "digraph"), ("g.mmd", "flowchart")]
)
def test_the_files_name_decides_the_graphs_format(hand_made, name, start):
    got = call("graph", "discs", "-o", name)
    assert got.exit_code == 0
    assert start in (hand_made / name).read_text()
    assert f"wrote {name}" in got.stderr


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "start"),
    [("g.png", b"\x89PNG"), pytest.param("g.pdf", b"%PDF", marks=pytest.mark.slow)],
)
def test_a_graph_is_a_picture_too(hand_made, name, start):
    got = call("graph", "discs", "-o", name)
    assert got.exit_code == 0
    assert (hand_made / name).read_bytes().startswith(start)
    piped = call("graph", "discs", "--format", name[2:])
    assert piped.stdout_bytes == (hand_made / name).read_bytes()


def test_a_picture_of_a_graph_is_not_poured_over_a_screen(hand_made, monkeypatch):
    monkeypatch.setattr("tactile_graph.cli.commands.graph.on_screen", lambda: True)
    got = call("graph", "discs", "--format", "png")
    assert got.exit_code == 2
    assert "--format png: is nothing to read on a screen; give -o FILE.png" in got.stderr


@pytest.mark.usefixtures("hand_made")
@pytest.mark.parametrize(
    ("args", "message"),
    [
        (["discs", "-o", "g.bmp"], "-o g.bmp: its name must end in .svg, .png, .pdf, .mmd"),
        (["discs", "-o", "g.pgn"], "or give --format; did you mean '.png'?"),
        (["dics"], "no pipeline named 'dics'; did you mean 'discs'?"),
        ([], "name a pipeline, or a file of one"),
        (["discs", "-o", "no/g.svg"], "-o no/g.svg: there is no folder 'no'"),
    ],
)
def test_mistakes_with_graphs(args, message):
    got = call("graph", *args)
    assert got.exit_code == 2
    assert message in got.stderr


@pytest.mark.usefixtures("hand_made")
def test_a_file_that_ends_too_early_is_no_ctrl_d(monkeypatch):
    """What click takes for one, as a truncated file of a plugin, is an error by its name."""

    def cut(*_: object) -> None:
        raise EOFError("marshal data too short")

    monkeypatch.setattr("tactile_graph.cli.commands.graph.on_screen", cut)
    got = call("graph", "discs", "--format", "png")
    assert got.exit_code == 2
    assert "error: EOFError: marshal data too short\n" in got.stderr
    assert "interrupted" not in got.stderr


# -- explain -------------------------------------------------------------------------------------


@pytest.mark.usefixtures("hand_made")
def test_explain_shows_values_and_times_of_what_ran():
    got = call("explain", "discs", "--frame", 2)
    assert "\ntimes are of a first frame: what is made, read or compiled once is in" in got.stdout
    assert got.exit_code == 0
    assert "discs, frame 2 of made: 4 x 6 volt, total 4" in got.stdout
    rows = {line.split()[0]: line for line in got.stdout.splitlines() if line.strip()}
    assert "Mask 4 x 6, count 4, area 4 cm²" in rows["footprint"]
    assert "Circle: x 3 cm, y 2 cm, radius 1.1284 cm" in rows["circle"]
    assert rows["circle"].split()[1:4] == ["*", "disc", "ran"]
    assert float(rows["footprint"].split()[3]) > 0


@pytest.mark.usefixtures("hand_made")
def test_explain_says_why_a_node_was_skipped():
    got = call("explain", "discs", "--with", "empty=[1]", "--frame", 1)
    assert got.exit_code == 0
    assert "skipped" in got.stdout
    assert "when footprint.count > 0 is false (footprint.count = 0)" in got.stdout


@pytest.mark.usefixtures("hand_made")
def test_explain_says_where_a_node_failed_and_with_what():
    got = call("explain", "discs", "--set", "circle.crash=true")
    assert got.exit_code == 1
    assert "ZeroDivisionError: divided by nothing" in got.stdout
    assert "helpers_cli.py:" in got.stdout
    assert "with Mask 4x6" in got.stdout


@pytest.mark.usefixtures("hand_made")
def test_explain_of_a_frame_that_does_not_come(hand_made):
    (hand_made / "a.txt").write_text("1\n2\n")
    got = call("explain", "loads", "a.txt", "--frame", 7)
    assert got.exit_code == 2
    assert "--frame 7: the source gave 2 frames, the first is 0" in got.stderr


# -- schema --------------------------------------------------------------------------------------


def test_schema_goes_to_a_file_or_to_stdout(hand_made):
    got = call("schema", "-o", "pipeline.schema.json")
    assert got.exit_code == 0
    assert "wrote pipeline.schema.json" in got.stderr
    written = json.loads((hand_made / "pipeline.schema.json").read_text())
    assert written["$schema"] == "https://json-schema.org/draft/2020-12/schema"
    assert written == json.loads(call("schema").stdout)


def test_schema_names_the_steps_it_left_open(hand_made, monkeypatch):
    install(monkeypatch, hand_made, steps={"lost": "tg_no_such_module:lost"})
    got = call("schema")
    assert got.exit_code == 0
    assert "left open: 'lost' of plugin 'hand'" in got.stderr


def completed(words: str) -> subprocess.CompletedProcess[str]:
    asked = {
        "_TACTILE_GRAPH_COMPLETE": "bash_complete",
        "COMP_WORDS": f"tactile-graph {words}",
        "COMP_CWORD": str(len(words.split(" "))),
    }
    return subprocess.run(
        [Path(sys.executable).with_name("tactile-graph")], env={**os.environ, **asked},
        capture_output=True, text=True, check=False,
    )  # fmt: skip


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("bash") is None, reason="no bash is there")
def test_the_line_that_the_reference_gives_has_bash_complete_words() -> None:
    page = Path(__file__).parents[3] / "docs" / "reference.md"
    line = next(ln for ln in page.read_text("utf-8").splitlines() if ln.startswith("eval "))
    folder = Path(sys.executable).parent
    words = "COMP_WORDS=(tactile-graph run circle-f); COMP_CWORD=2"
    told = '_tactile_graph_completion tactile-graph; echo "${COMPREPLY[@]}"'
    got = subprocess.run(
        ["bash", "-c", f"{line}\n{words}\n{told}"], capture_output=True, text=True, check=True,
        env={**os.environ, "PATH": f"{folder}{os.pathsep}{os.environ['PATH']}"},
    )  # fmt: skip
    assert got.stdout.split() == ["circle-followed", "circle-full"]


@pytest.mark.slow
@pytest.mark.parametrize(
    "words",
    [
        "foo ", "run circle-1 --no-such ", "run --plugins -nosuch ", "run no-such --set f",
        "run --only ", "run circle-1 --source no-such --with ",
    ],
)  # fmt: skip
def test_completing_a_word_of_a_line_tells_no_error(words: str) -> None:
    got = completed(words)
    assert got.stderr == ""
    assert "error" not in got.stdout


@pytest.mark.slow
@pytest.mark.parametrize(
    ("words", "offered"),
    [
        ("run circle-3 --source sim", ["simulate"]),
        ("run circle-3 --source simulate --with scen", ["scene="]),
        ("run circle-3 a.npz --with transp", ["transpose="]),
        ("run circle-3 --set fine.f", ["fine.factor="]),
        ("run circle-3 --only fo", ["footprint"]),
        ("compare circle-3 --set fine.f", ["fine.factor="]),
        ("live circle-3 --set fine.f", ["fine.factor="]),
        ("convert a.npz --source sim", ["simulate"]),
        ("reproduce table-4.", [f"table-4.{k}" for k in (3, 4, 5, 7, 8, 9)]),
    ],
)
def test_a_word_is_completed_by_what_there_is(words: str, offered: list[str]) -> None:
    lines = [line.partition(",")[2] for line in completed(words).stdout.split()]
    assert lines == offered
