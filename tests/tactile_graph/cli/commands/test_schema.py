"""``schema`` of a file, and ``--install``: what editors complete, say and are told."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import jsonschema
import pytest
import yaml

from helpers_cli import call
from helpers_schema import hover, keys_offered, offered
from tactile_graph.plugins.registry import installed
from tactile_graph.schema import pipeline_schema

MINE = """\
pipeline: mine
source: {step: simulate, with: {scene: discs}}
conditions: {touched: footprint.count > 3}
nodes:
  footprint: {step: threshold, in: frame, with: {level_v: 0.01}}
  objects: {step: contacts, in: [frame, footprint], when: touched}
  fits: {use: circle-1, in: frame}
outputs: [objects]
"""


@pytest.fixture
def mine(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "mine.yaml"
    path.write_text(MINE)
    return path


@pytest.fixture(scope="module")
def shipped() -> dict[str, Any]:
    return pipeline_schema(installed())[0]


@pytest.mark.slow
def test_a_files_own_schema_completes_its_nodes_in_wires_and_conditions(mine: Path) -> None:
    got = call("schema", "mine.yaml")
    assert got.exit_code == 0
    made, data = json.loads(got.stdout), yaml.safe_load(MINE)
    assert list(jsonschema.Draft202012Validator(made).iter_errors(data)) == []
    names = ["frame", "footprint", "objects", "objects.contacts", "objects.count", "fits"]
    for place in (("nodes", "footprint", "in"), ("nodes", "objects", "in", 1), ("outputs", 0)):
        assert list(dict.fromkeys(offered(made, data, *place))) == names
    values = offered(made, data, "nodes", "objects", "when")
    assert values[0] == "touched"
    assert {"frame.index", "footprint.count", "objects.count", "fits.radius_cm"} <= set(values)
    assert "any(objects.contacts.peak)" in values
    assert "footprint.values" not in values
    new = MINE.replace("when: touched", "when: any(objects.contacts.peak > 2)")
    new = new.replace("in: [frame", "in: [not_written_yet")
    assert jsonschema.Draft202012Validator(made).is_valid(yaml.safe_load(new))


@pytest.mark.slow
def test_a_files_own_schema_is_a_schema_of_its_draft(mine: Path) -> None:
    jsonschema.Draft202012Validator.check_schema(json.loads(call("schema", "mine.yaml").stdout))


@pytest.mark.slow
def test_a_file_with_problems_completes_what_can_be_told(mine: Path) -> None:
    mine.write_text(MINE.replace("in: [frame, footprint]", "in: [frame, ftprint]"))
    made = json.loads(call("schema", "mine.yaml").stdout)
    names = offered(made, yaml.safe_load(MINE), "outputs", 0)
    assert {"footprint", "objects", "objects.contacts", "fits"} <= set(names)


@pytest.mark.slow
def test_only_the_chosen_steps_settings_and_ports_are_offered(shipped: dict[str, Any]) -> None:
    data = yaml.safe_load(MINE)
    settings = keys_offered(shipped, data, "nodes", "footprint", "with")
    assert settings == [s.name for s in installed().step("threshold").settings]
    data["nodes"]["objects"]["in"] = {"mask": "footprint"}
    assert keys_offered(shipped, data, "nodes", "objects", "in") == ["image", "mask"]
    assert keys_offered(shipped, data, "source", "with") == [
        s.name for s in installed().step("simulate").settings
    ]


def test_hover_tells_what_the_step_its_settings_and_ports_are(shipped: dict[str, Any]) -> None:
    data = yaml.safe_load(MINE)
    node = ("nodes", "footprint")
    assert hover(shipped, data, *node, "step") == "Turn on the valid cells at or above a level."
    assert hover(shipped, data, *node, "with").startswith("Settings of threshold: Turn on")
    assert hover(shipped, data, *node, "with", "level_v").endswith("(float | None)")
    assert hover(shipped, data, *node, "in") == "Ports of threshold: image (Image)."
    assert hover(shipped, data, "nodes", "fits", "in").startswith("The pipeline's frame, or a map")


def test_every_setting_of_every_step_says_what_it_does(shipped: dict[str, Any]) -> None:
    silent = [
        f"{step.removesuffix('.with')}.{name}"
        for step, part in shipped["$defs"].items()
        if step.endswith(".with")
        for name, setting in part["properties"].items()
        if setting["description"].startswith("(")
    ]
    assert silent == []


def test_a_pads_file_has_the_schema_of_pads(mine: Path) -> None:
    Path("pad.yaml").write_text("geometry: {rows: 8, columns: 8}\n")
    got = call("schema", "pad.yaml")
    assert json.loads(got.stdout)["title"] == "tactile-graph pad"


# -- --install -----------------------------------------------------------------------------------

LINE = "# yaml-language-server: $schema=./.tactile-graph/mine.yaml.schema.json\n"
SCHEMAS = {"./.tactile-graph/mine.yaml.schema.json": ["mine.yaml"]}


def test_install_writes_the_schema_the_line_and_the_settings(mine: Path) -> None:
    Path("notes.yaml").write_text("just: notes\n")
    got = call("schema", "--install")
    assert got.exit_code == 0, got.stderr
    assert mine.read_text() == LINE + MINE
    made = json.loads(Path(".tactile-graph/mine.yaml.schema.json").read_text())
    assert "objects" in offered(made, yaml.safe_load(MINE), "outputs", 0)
    assert json.loads(Path(".vscode/settings.json").read_text()) == {"yaml.schemas": SCHEMAS}
    assert Path("notes.yaml").read_text() == "just: notes\n"
    assert call("check", "mine.yaml").exit_code == 0


def test_install_finds_a_pipeline_that_begins_with_a_byte_order_mark(mine: Path) -> None:
    mine.write_text("\ufeff" + MINE, encoding="utf-8")
    got = call("schema", "--install")
    assert got.exit_code == 0, got.stderr
    assert mine.read_text(encoding="utf-8") == "\ufeff" + LINE + MINE


def test_install_leaves_a_pipeline_in_the_encoding_it_has(mine: Path) -> None:
    mine.write_text("\ufeff" + MINE, encoding="utf-16-le")
    got = call("schema", "--install", str(mine))
    assert got.exit_code == 0, got.stderr
    assert mine.read_bytes().decode("utf-16-le") == "\ufeff" + LINE + MINE


@pytest.mark.slow
def test_install_again_takes_up_new_nodes_and_changes_nothing_else(mine: Path) -> None:
    assert call("schema", "--install", "mine.yaml").exit_code == 0
    mine.write_text(mine.read_text().replace("  fits:", "  more: {step: load, in: frame}\n  fits:"))
    before = mine.read_text()
    assert call("schema", "--install", "mine.yaml").exit_code == 0
    assert mine.read_text() == before
    made = json.loads(Path(".tactile-graph/mine.yaml.schema.json").read_text())
    assert "more" in offered(made, yaml.safe_load(before), "outputs", 0)


@pytest.mark.slow
def test_line_ends_and_a_byte_order_mark_stay(mine: Path) -> None:
    mine.write_bytes(b"\xef\xbb\xbf" + MINE.replace("\n", "\r\n").encode())
    assert call("schema", "--install", "mine.yaml").exit_code == 0
    assert mine.read_bytes() == b"\xef\xbb\xbf" + (LINE + MINE).replace("\n", "\r\n").encode()


def test_a_line_that_names_another_schema_is_not_touched(mine: Path) -> None:
    mine.write_text("# a remark\n# yaml-language-server: $schema=https://x.org/s.json\n" + MINE)
    got = call("schema", "--install", "mine.yaml")
    assert got.exit_code == 2
    assert "mine.yaml:2: it names the schema 'https://x.org/s.json' already" in got.stderr
    assert not Path(".tactile-graph").exists()


def settings(text: str) -> Path:
    path = Path(".vscode", "settings.json")
    path.parent.mkdir()
    path.write_text(text)
    return path


@pytest.mark.slow
def test_settings_of_others_stay_as_they_are(mine: Path) -> None:
    path = settings('{\n  "editor.rulers": [100],\n  "yaml.schemas": {"a.json": "*.yml"}\n}\n')
    assert call("schema", "--install", "mine.yaml").exit_code == 0
    assert path.read_text().startswith('{\n  "editor.rulers": [\n')
    assert json.loads(path.read_text()) == {
        "editor.rulers": [100],
        "yaml.schemas": {"a.json": "*.yml", **SCHEMAS},
    }


@pytest.mark.slow
def test_the_mark_that_some_editors_put_before_settings_stays(mine: Path) -> None:
    path = settings('\ufeff{"editor.rulers": [100]}\n')
    assert call("schema", "--install", "mine.yaml").exit_code == 0
    assert path.read_bytes().startswith(b"\xef\xbb\xbf{")
    assert json.loads(path.read_text(encoding="utf-8-sig"))["yaml.schemas"] == SCHEMAS


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ('{\n  // mine\n  "editor.rulers": [100]\n}\n', "line 2 column 3"),
        ('{"yaml.schemas": []}', "'yaml.schemas' in it is none"),
        ('{"a": 1, "a": 2}', "'a' stands in it twice"),
    ],
)
def test_settings_that_would_lose_something_are_left_and_what_to_add_is_shown(
    mine: Path, text: str, why: str
) -> None:
    path = settings(text)
    got = call("schema", "--install", "mine.yaml")
    assert got.exit_code == 2
    assert path.read_text() == text
    assert why in got.stderr
    shown = got.stderr[got.stderr.index("add to it:\n") + len("add to it:\n") :]
    assert json.loads(shown) == {"yaml.schemas": SCHEMAS}
    assert mine.read_text().startswith(LINE)  # the rest is done


def test_a_file_on_another_drive_gets_its_schema_and_no_place_in_these_settings(
    mine: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def other_drive(path: str, start: str = "") -> str:
        raise ValueError("path is on mount 'D:', start on mount 'C:'")

    monkeypatch.setattr(os.path, "relpath", other_drive)
    got = call("schema", "--install", str(mine))
    assert got.exit_code == 0, got.stderr
    assert mine.read_text() == LINE + MINE
    assert json.loads(Path(".vscode/settings.json").read_text()) == {"yaml.schemas": {}}


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("--install", "gone.yaml"), "gone.yaml cannot be read: No such file"),
        (("--install", "--keys"), "it takes no --keys and no -o"),
        (("pad", "preset"), "one schema at a time, got 2"),
    ],
)
@pytest.mark.usefixtures("mine")
def test_what_cannot_be_asked_is_told(words: tuple[str, ...], told: str) -> None:
    got = call("schema", *words)
    assert got.exit_code == 2
    assert told in str(got.exception) + got.stderr


def test_a_folder_without_pipelines_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert "no pipeline file is in this folder" in call("schema", "--install").stderr
