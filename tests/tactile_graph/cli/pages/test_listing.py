"""Lists of files that plugins offer: a line each, or one as it stands."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers_cli import call, install
from helpers_kinds import lamp_plugin

COMMANDS = {"scenes": "tactile_graph_sources.commands.scenes:scenes"}


@pytest.fixture
def lamps(hand_made: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    offer = lamp_plugin(hand_made)
    install(monkeypatch, hand_made, ("lamps", "lamp-package", "1", offer), commands=COMMANDS)
    return hand_made


@pytest.mark.usefixtures("lamps")
def test_each_is_a_line_with_what_its_file_says_of_itself() -> None:
    assert call("scenes").stdout == "desk   the lamp desk\ndiscs  the lamp discs\n"


def test_a_file_that_cannot_be_read_is_told_in_its_line_and_the_rest_goes_on(lamps: Path) -> None:
    (lamps / "desk-lamp.yaml").write_text("about: [")
    (lamps / "discs-lamp.yaml").unlink()
    desk, discs = call("scenes").stdout.splitlines()
    assert desk.startswith("desk   desk-lamp.yaml:1:9: this is not YAML")
    assert discs.startswith("discs  ")
    assert "cannot be read" in discs


def test_a_name_prints_the_file_as_it_stands(lamps: Path) -> None:
    assert call("scenes", "desk").stdout == (lamps / "desk-lamp.yaml").read_text()
    got = call("scenes", "dsek")
    assert got.exit_code == 2
    assert "no scene named 'dsek'; did you mean 'desk'?" in got.stderr


def test_nothing_on_offer_is_said(hand_made: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    install(monkeypatch, hand_made, commands=COMMANDS)
    assert call("scenes").stdout == "no plugin offers scenes\n"
