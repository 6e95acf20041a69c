"""``plugins --check``: commands and readers that the command line could not use are told."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from helpers_cli import call, install, made, pressed, recording
from tactile_graph.testing.plugin_check import PluginReport

CODE = """\
import click

@click.command()
def right():
    pass

def f():
    pass

n = 3
"""


@pytest.fixture
def commands(hand_made: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (hand_made / "tg_bcmd.py").write_text(CODE)
    monkeypatch.syspath_prepend(str(hand_made))
    return hand_made


def checked(folder: Path, monkeypatch: pytest.MonkeyPatch, **offers: Any) -> tuple[int, str]:
    # Steps are tried elsewhere; here only what the other hooks say of them.
    monkeypatch.setattr("tactile_graph.testing.plugin_check._look_at_step", lambda *_: None)
    install(monkeypatch, folder, **{"readers": {}, **offers})
    got = call("plugins", "--check", "hand")
    return got.exit_code, got.stdout


@pytest.mark.parametrize("name", ["f", "n"])
def test_a_command_that_is_none_of_clicks_is_told_where_it_is_called_too(
    commands: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    code, told = checked(commands, monkeypatch, commands={"badcmd": f"tg_bcmd:{name}"})
    assert code == 2
    assert "command 'badcmd' of plugin 'hand' (package hand-made) must be a click.Command" in told
    for _ in range(2):  # what was refused once is not taken the next time
        got = call("badcmd")
        assert got.exit_code == 2
        assert "must be a click.Command, got " in got.stderr


def test_a_command_named_like_one_of_the_projects_own_is_told(
    commands: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    code, told = checked(commands, monkeypatch, commands={"run": "tg_bcmd:right"})
    assert code == 2
    assert "is refused: tactile-graph has its own" in told
    assert checked(commands, monkeypatch, commands={"mine": "tg_bcmd:right"})[0] == 0


@pytest.mark.parametrize(
    ("readers", "message"),
    [
        ({"pressed": "level_v"}, "reader 'pressed': this step is no source: it yields no frames"),
        ({"made": "pathh"}, "reader 'made': the step has no setting 'pathh'; its settings are: "),
        ({"recording": "paht"}, "the step has no setting 'paht'; did you mean 'path'?"),
    ],
)
def test_a_reader_that_cannot_read_is_told(
    hand_made: Path, monkeypatch: pytest.MonkeyPatch, readers: dict[str, str], message: str
) -> None:
    steps = {"made": made, "pressed": pressed, "recording": recording}
    code, told = checked(hand_made, monkeypatch, readers=readers, steps=steps)
    assert code == 2
    assert message in told
    assert checked(hand_made, monkeypatch, readers={"recording": "path"})[0] == 0


@pytest.mark.parametrize(("words", "said"), [
    (("--check", "pads", "hull"), ["hull", "pads"]),
    (("hull", "--check"), ["hull"]),
    (("--check=hull", "hull"), ["hull"]),
])  # fmt: skip
def test_several_plugins_are_checked_at_once(
    monkeypatch: pytest.MonkeyPatch, words: tuple[str, ...], said: list[str]
) -> None:
    # What is wrong with each is told elsewhere; here only which ones are looked at.
    monkeypatch.setattr(
        "tactile_graph.testing.plugin_check.examine_plugin",
        lambda plugin, *_: PluginReport(plugin),
    )
    got = call("plugins", *words)
    assert got.exit_code == 0
    assert [line.split()[0] for line in got.stdout.splitlines()] == said


def test_a_second_name_that_is_none_is_told_and_names_alone_are_refused() -> None:
    got = call("plugins", "--check", "pads", "hul")
    assert (got.exit_code, got.stdout) == (2, "")
    assert "no plugin named 'hul'; did you mean 'hull'?" in got.stderr
    got = call("plugins", "hull")
    assert got.exit_code == 2
    assert "hull: names are for --check: tactile-graph plugins --check NAME" in got.stderr
