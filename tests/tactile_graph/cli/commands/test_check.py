"""``check`` and ``schema`` for every kind of file, one of a stranger's plugin among them."""

from __future__ import annotations

import json
import re
from pathlib import Path

import jsonschema
import numpy as np
import pytest
import yaml

from helpers_cli import call, install
from helpers_kinds import lamp_plugin

DARK = "about: dark\nbulbs:\n  - {watt: 40}\n  - {watt: 0}\n"


@pytest.fixture
def lamps(hand_made: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    install(monkeypatch, hand_made, ("lamps", "lamp-package", "1", lamp_plugin(hand_made)))
    return hand_made


def test_a_file_is_checked_as_what_its_keys_say_it_is(lamps: Path) -> None:
    (lamps / "my.yaml").write_text("bulbs: [{watt: 3}]\n")
    got = call("check", "my.yaml", "discs.yaml")
    assert got.exit_code == 0
    assert got.stdout.splitlines() == [
        "my.yaml: right  lamp: 1 bulbs",
        "discs: right  2 nodes → circle; takes frames from made",
    ]


@pytest.mark.slow
def test_what_a_file_marks_free_is_told_with_its_values(hand_made: Path) -> None:
    text = (hand_made / "discs.yaml").read_text()
    marked = text.replace("with: {level_v: 0.5}", "free: {level_v: [0.25, 0.5]}")
    (hand_made / "marked.yaml").write_text(marked)
    got = call("check", "marked.yaml")
    assert got.exit_code == 0
    assert "\n  free for tune: footprint.level_v: 0.25, 0.5\n" in got.stdout


@pytest.mark.parametrize(
    ("evolves", "circle"),
    [
        (("2.yaml", "3.yaml", "2.yaml"), "n2 -> n3 -> n2"),
        (("1.yaml", "discs", "loads"), "n1 -> n1"),
        (("2.yaml", "3.yaml", "discs"), ""),
        (("2.yaml", "3.yaml", "gone"), ""),
    ],
)
def test_pipelines_that_evolve_from_each_other_are_told(
    hand_made: Path, evolves: tuple[str, ...], circle: str
) -> None:
    text = (hand_made / "discs.yaml").read_text()
    for i, parent in enumerate(evolves, 1):
        head = f"pipeline: n{i}\nevolves: {parent}"
        (hand_made / f"{i}.yaml").write_text(text.replace("pipeline: discs", head))
    got = call("check", "1.yaml")
    assert got.exit_code == 0
    assert got.stdout.partition("\n  evolves in a circle: ")[2].strip() == circle


def test_all_that_is_wrong_with_a_plugins_file_is_told_with_its_line(lamps: Path) -> None:
    (lamps / "dark.yaml").write_text(DARK)
    got = call("check", "dark.yaml")
    assert got.exit_code == 2
    assert "dark.yaml: wrong\ndark.yaml:4:12: watt must be > 0, got 0\n" in got.stdout
    assert "  4 |   - {watt: 0}\n" in got.stdout


@pytest.mark.usefixtures("lamps")
def test_a_name_means_a_pipeline_first_and_what_as_says_otherwise() -> None:
    assert "discs: right  2 nodes" in call("check", "discs").stdout
    assert call("check", "desk").stdout == "desk: right  lamp: 2 bulbs\n"
    assert call("check", "discs", "--as", "lamp").stdout == "discs: right  lamp: 2 bulbs\n"


def test_a_name_or_file_that_may_be_several_kinds_asks_for_the_word(
    hand_made: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    twice = lamp_plugin(hand_made, torch="helpers_kinds:LAMP")
    install(monkeypatch, hand_made, ("lamps", "lamp-package", "1", twice))
    got = call("check", "desk")
    assert got.exit_code == 2
    assert "'desk' is a lamp or torch; say which by --as" in got.stdout
    (hand_made / "plain.yaml").write_text("about: anything\n")
    told = call("check", "plain.yaml").stdout
    assert "'plain.yaml' may be a pipeline, lamp or torch by its keys; say which by --as" in told
    assert call("check", "plain.yaml", "--as", "lamp").stdout.startswith("plain.yaml: right  lamp")


@pytest.mark.usefixtures("lamps")
def test_without_names_all_that_is_installed_is_checked_or_all_of_a_kind() -> None:
    assert call("check").stdout.count(": right") == 4
    assert call("check", "--as", "lamp").stdout.count(": right  lamp") == 2


@pytest.mark.usefixtures("lamps")
@pytest.mark.parametrize(
    ("args", "message"),
    [
        (["check", "desk", "--as", "lmap"], "no kind of file named 'lmap'; did you mean 'lamp'?"),
        (["schema", "zzzz"], "no kind of file named 'zzzz'; there are: lamp, pipeline"),
        (["schema", "--keys"], "tactile-graph steps NAME"),
        (["schema", "lamp", "--keys", "-o", "x.json"], "it takes no -o"),
    ],
)
def test_a_mistake_is_a_line_and_exit_code_2(args: list[str], message: str) -> None:
    got = call(*args)
    assert got.exit_code == 2
    assert message in got.stderr


def test_where_no_file_is_named_there_is_nothing_to_wait_for() -> None:
    got = call("check", "--watch", "-")
    assert got.exit_code == 2
    assert got.stdout.startswith("-: wrong\n")
    assert got.stdout.endswith("there is no file to watch\n")


def test_a_plugins_kind_that_is_none_is_told_by_plugin(
    hand_made: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    bad = lamp_plugin(hand_made, torch="helpers_kinds:NO_KIND")
    install(monkeypatch, hand_made, ("lamps", "lamp-package", "1", bad))
    got = call("schema", "torch")
    assert got.exit_code == 2
    told = "file kind 'torch' of plugin 'lamps' (package lamp-package) must be a FileKind, got 3"
    assert told in got.stderr


# -- schema --------------------------------------------------------------------------------------


@pytest.mark.usefixtures("lamps")
def test_the_schema_says_of_every_key_what_the_docstrings_say() -> None:
    made = json.loads(call("schema", "lamp").stdout)
    jsonschema.Draft202012Validator.check_schema(made)
    assert made["title"] == "tactile-graph lamp"
    bulbs = made["else"]["properties"]["bulbs"]
    assert bulbs["description"] == "What is in it; `null` is no bulb."
    assert made["$defs"]["Bulb"]["description"] == "What is screwed into a lamp."
    validator = jsonschema.Draft202012Validator(made)
    assert validator.is_valid(yaml.safe_load(DARK.replace("watt: 0", "watt: 1")))
    assert not validator.is_valid(yaml.safe_load(DARK))
    assert not validator.is_valid({"bulbs": [{"watt": 1}], "colour": "red"})
    assert not validator.is_valid({"about": "nothing in it"})


@pytest.mark.usefixtures("lamps")
def test_a_file_laid_over_another_need_not_say_everything_but_nothing_unknown() -> None:
    validator = jsonschema.Draft202012Validator(json.loads(call("schema", "lamp").stdout))
    assert validator.is_valid({"like": "desk"})
    assert validator.is_valid({"like": "desk", "bulbs": [{}]})
    assert not validator.is_valid({"like": "desk", "bulbs": [{"volt": 3}]})
    assert not validator.is_valid({"like": 3})


@pytest.mark.usefixtures("lamps")
def test_keys_are_shown_as_tables_for_people() -> None:
    text = " ".join(call("schema", "lamp", "--keys").stdout.split())
    assert text.startswith("a lamp file A lamp. key holds default")
    assert "bulbs list of sections required What is in it; `null` is no bulb." in text
    assert "bulbs[] What is screwed into a lamp." in text
    assert "watt number > 0 required" in text


# -- lists ---------------------------------------------------------------------------------------


@pytest.mark.usefixtures("lamps")
def test_plugins_counts_kinds_of_files_in_words() -> None:
    assert "2 scenes, 1 file kind" in call("plugins").stdout


@pytest.mark.slow
def test_the_files_that_a_source_names_are_opened_and_all_that_is_wrong_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("scene.yaml").write_text("objects:\n  - {shape: circel, x_cm: 3, y_cm: 4}\n")
    Path("pad.yaml").write_text("geometry: {rows: 12, columns: -3}\n")
    Path("mine.yaml").write_text("preset: mine\ntransport: {baud: fast}\n")
    Path("words.csv").write_text("hello there\n")
    Path("off.yaml").write_text(
        "objects: [{shape: disc, weight_g: 9, radius_cm: 2, place: [200, 3]}]\n"
    )
    np.savez("flat.npz", values=np.ones((4, 8, 8)))
    wrong = {
        "simulate, with: {scene: scene.yaml}": ["scene.yaml:2:", "circel"],
        "simulate, with: {scene: discsss}": ["p.yaml:1:16: source, scene: no scene named", "discs"],
        "simulate, with: {scene: off.yaml, pad: plain}": [
            "p.yaml:1:16: source: object 1: at place [200, 3] it lies wholly off the pad of 20.5",
        ],
        "simulate, with: {pad: pad.yaml}": ["pad.yaml:1:31: columns must be >= 1, got -3"],
        "serial, with: {port: /dev/x, preset: mine.yaml}": ["mine.yaml:2:19: transport.baud"],
        "recording, with: {path: words.csv}": ["p.yaml:1:16: source, path: words.csv: no rec"],
        "recording, with: {path: [gone.csv, words.csv, flat.npz]}": [
            "path: gone.csv: there is no such file", "path: words.csv: no recording", "2 problems",
        ],
        "replay, with: {path: words.csv}": ["source, path: words.csv: no recording"],
    }  # fmt: skip
    rest = "nodes:\n  load: {step: load, in: frame}\noutputs: [load]\n"
    for source, words in wrong.items():
        head = f"source: {{step: {source}}}\npipeline: p\nabout: x\n"
        Path("p.yaml").write_text(head + rest)
        done = call("check", "p.yaml")
        assert done.exit_code == 2, source
        for word in words:
            assert word in done.stdout, (source, done.stdout)
    Path("p.yaml").write_text(
        "pipeline: p\nabout: x\nsource: {step: recording, with: {path: flat.npz}}\n" + rest
    )
    assert call("check", "p.yaml").exit_code == 0


@pytest.mark.parametrize(
    ("source", "node"),
    [
        ("recording, with: {path: a.csv}", "threshold, in: frame, with: {level: 1}"),
        ("serial, with: {port: x, preset: a.yaml}", "threshold, in: frame, with: {level: 1}"),
        ("simulate, with: {scene: discs}", "correct_readings, in: frame, with: {pad: a.yaml}"),
    ],
)
def test_a_file_that_lies_beside_the_pipeline_is_missed_with_its_place(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, source: str, node: str
) -> None:
    """What settings name is looked for from the current folder."""
    monkeypatch.chdir(tmp_path)
    Path("sub").mkdir()
    Path("sub/a.csv").touch()
    Path("sub/a.yaml").touch()
    text = f"pipeline: p\nsource: {{step: {source}}}\nnodes: {{n: {{step: {node}}}}}\n"
    Path("sub/p.yaml").write_text(text + "outputs: [n]\n")
    for command in ("check", "run"):
        result = call(command, "sub/p.yaml")
        assert result.exit_code == 2
        told = " ".join(result.output.split())
        assert re.search(r"from the current folder: did you mean 'sub/a\.(csv|yaml)'\?", told)
        assert "Errno" not in told
