"""``steps``: the list made without imports, and a step's page."""

from __future__ import annotations

import subprocess
import sys
from typing import Annotated, Any

import pytest
from annotated_types import Ge, Len, MultipleOf
from click.testing import CliRunner

from helpers_cli import call, install
from tactile_graph.cli import cli
from tactile_graph.cli.pages.step_page import made_up_use, ranges
from tactile_graph.steps.signature import read_signature

LATER = '''
import tg_heavy_library

def late(image: "Image", *, n: int = 1) -> "Mask":
    """Return a mask, late. Not told in lists."""
'''


@pytest.fixture
def _late(hand_made, monkeypatch):
    (hand_made / "tg_late_steps.py").write_text(LATER)
    monkeypatch.syspath_prepend(str(hand_made))
    steps = {"late": "tg_late_steps:late", "lost": "tg_late_steps:lost"}
    install(monkeypatch, hand_made, steps=steps)


@pytest.mark.usefixtures("_late")
def test_the_list_shows_ports_output_and_first_sentence_without_importing_a_step():
    got = call("steps")
    assert got.exit_code == 0
    rows = {
        line.split()[0]: " ".join(line.split()) for line in got.stdout.splitlines() if line.strip()
    }
    assert rows["late"] == "late Image → Mask A mask, late"
    assert rows["disc"] == "disc Mask → Circle The circle of the mask's area about its centre"
    assert rows["merge"] == "merge masks: list[Mask] → Mask The cells on in any"
    assert (
        rows["made"] == "made → frames Frames of a disc that moves to the right, with their truth"
    )
    assert "tg_late_steps has no 'lost'" in rows["lost"]
    assert "tg_late_steps" not in sys.modules


@pytest.mark.usefixtures("_late")
@pytest.mark.parametrize("width", [40, 60])
def test_on_a_narrow_screen_what_belongs_to_a_step_stands_under_its_name_whole(width: int):
    got = CliRunner(env={"COLUMNS": str(width)}).invoke(cli, ["steps"]).stdout
    assert "\n  late\n    Image → Mask\n    A mask, late\n" in got
    assert all(len(line) <= width for line in got.splitlines())
    assert "…" not in got


@pytest.mark.usefixtures("hand_made")
def test_on_a_narrow_screen_no_word_is_cut():
    for args in (["steps", "pressed"], ["steps", "disc", "-s"], ["explain", "discs"]):
        got = CliRunner(env={"COLUMNS": "40"}).invoke(cli, args)
        assert got.exit_code == 0
        assert "…" not in got.stdout


@pytest.mark.usefixtures("hand_made")
def test_a_page_shows_ports_settings_with_ranges_and_meanings_output_and_use():
    got = call("steps", "pressed")
    assert got.exit_code == 0
    text = " ".join(got.stdout.split())
    assert text.startswith("pressed step of plugin hand (hand-made 1.2)")
    assert "image Image volt In volts." in text
    assert "level_v float 0.5 > 0 From where on a cell is on." in text
    assert "Mask grid of image .count int .area_cm2 float" in text
    assert (
        "in a pipeline, as discs has it footprint: {step: pressed, in: frame, with: {level_v: 0.5}}"
        in text
    )


@pytest.mark.usefixtures("hand_made")
def test_a_sources_page():
    text = " ".join(call("steps", "recording").stdout.split())
    assert text.startswith("recording source of plugin hand")
    assert "path Path | list[Path] (required)" in text
    assert "source: {step: recording, with: {path: recording.csv}}" in text


@pytest.mark.usefixtures("hand_made")
def test_a_named_tuples_page_shows_its_fields():
    text = " ".join(call("steps", "load").stdout.split())
    assert ".total float .x_cm float | None .parts list[int]" in text


@pytest.mark.usefixtures("_late")
@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("presed", "no step named 'presed'; did you mean 'pressed'?"),
        ("late", "'late' of plugin 'hand' (package hand-made): cannot import tg_late_steps: No "
                 "module named 'tg_heavy_library'"),
    ],
)  # fmt: skip
def test_a_step_that_cannot_be_shown_is_an_error_in_words(name, message):
    got = call("steps", name)
    assert got.exit_code == 2
    assert message in got.stderr


@pytest.mark.slow
def test_python_without_docstrings_is_told_to_leave_them_out():
    words = [sys.executable, "-OO", "-P", "-m", "tactile_graph", "steps", "threshold"]
    got = subprocess.run(words, capture_output=True, text=True, check=True)
    assert got.stderr == "python -OO leaves out what a step says of itself: run without it\n"
    assert got.stdout.startswith("threshold")


def test_ranges_are_told_through_unions_and_containers():
    kind = Annotated[int, Ge(1)] | Annotated[list[Annotated[float, MultipleOf(0.5)]], Len(2, 3)]
    assert ranges(kind | None) == ["≥ 1", "length 2 to 3", "multiple of 0.5"]


def test_a_made_up_use_fills_ports_and_required_settings_in():
    def join(a: int, b: float, c: str = "x", *, n: int, kind: Any = None) -> int:
        return 0

    use = made_up_use(read_signature("join", join))
    assert use == "my_join: {step: join, in: {a: a, b: b}, with: {'n': 2}}"
