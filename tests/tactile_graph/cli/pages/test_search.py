"""Search in ``steps`` and ``pipelines``: every word is mentioned, best first."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers_cli import LOADS, call, install
from tactile_graph.cli.pages.search import Entry, best_first


def names(*words: str, entries: list[Entry]) -> list[str]:
    return [hit.entry.name for hit in best_first(words, entries)]


NOISE = [
    Entry("told", "Of noise.", {}),
    Entry("set", "Nothing.", {"level": "Above the noise.", "other": "No."}),
    Entry("add_noise", "Nothing.", {}),
    Entry("noises", "Nothing.", {"noise_v": ""}),
    Entry("denoise", "Nothing.", {}),
    Entry("without", "Nothing.", {"level": "In volts."}),
]


def test_a_name_comes_before_the_line_about_it_and_that_before_a_setting() -> None:
    assert names("noise", entries=NOISE) == ["add_noise", "noises", "denoise", "told", "set"]
    assert [hit.parts for hit in best_first(["noise"], NOISE)][1:] == [
        ("noise_v",), (), (), ("level",),
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("words", "found"),
    [
        (["Noise", "level"], ["set"]),
        (["noise-level"], ["set"]),
        (["noi"], ["add_noise", "noises", "told", "set"]),
        (["noisy"], ["add_noise", "noises", "told", "set"]),
        (["ise"], []),
        (["nobody"], []),
        (["_"], []),
        (["volts"], ["without"]),
    ],
)
def test_every_word_is_mentioned_whole_begun_or_much_alike(
    words: list[str], found: list[str]
) -> None:
    assert names(*words, entries=NOISE) == found


# -- steps ---------------------------------------------------------------------------------------


@pytest.mark.usefixtures("hand_made")
def test_steps_are_found_by_name_first_line_and_settings_best_first() -> None:
    got = call("steps", "cells")
    assert got.exit_code == 0
    rows = [line.split()[0] for line in got.stdout.splitlines() if line.strip()]
    assert rows[2:] == ["merge", "pressed"]
    found = " ".join(call("steps", "cell", "on").stdout.split())
    assert "pressed The cells that are pressed level_v" in found


@pytest.mark.usefixtures("hand_made")
def test_a_steps_own_name_shows_it_unless_a_search_is_asked_for() -> None:
    assert call("steps", "load").stdout.startswith("load  step of plugin hand")
    assert "The load" in call("steps", "load", "-s").stdout
    assert "settings about it" in call("steps", "load", "--search").stdout


def test_a_step_that_cannot_be_imported_is_found_by_its_first_line(
    hand_made: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = 'import tg_nothing\ndef late(*, n: int = 1) -> int:\n    """Return a rarity."""\n'
    (hand_made / "tg_search_steps.py").write_text(text)
    monkeypatch.syspath_prepend(str(hand_made))
    install(monkeypatch, hand_made, steps={"late": "tg_search_steps:late"})
    assert "late   A rarity" in call("steps", "rarity").stdout


@pytest.mark.usefixtures("hand_made")
@pytest.mark.parametrize(
    ("args", "message"),
    [
        (["steps", "presed"], "no step named 'presed'; did you mean 'pressed'? (and none mentions"),
        (["steps", "big", "cat"], "no step mentions all of 'big cat'; tactile-graph steps lists"),
        (["pipelines", "dics"], "no pipeline named 'dics'; did you mean 'discs'? (and none menti"),
        (["pipelines", "big", "cat"], "no pipeline mentions all of 'big cat'"),
    ],
)
def test_nothing_found_is_said_with_what_is_near(args: list[str], message: str) -> None:
    got = call(*args)
    assert got.exit_code == 2
    assert message in got.stderr


# -- pipelines -----------------------------------------------------------------------------------


@pytest.mark.usefixtures("hand_made")
def test_pipelines_are_found_by_what_they_say_and_by_the_steps_they_run() -> None:
    assert call("pipelines", "hand", "disc").stdout == (
        "discs  A disc on hand-made frames  runs disc\n"
    )
    assert call("pipelines", "merge").stdout == "loads  Load  runs merge\n"
    assert call("pipelines", "load", "-s").stdout.splitlines()[0] == "loads  Load  runs load"


@pytest.mark.usefixtures("hand_made")
def test_a_pipelines_own_name_prints_its_file() -> None:
    assert call("pipelines", "loads").stdout == LOADS
