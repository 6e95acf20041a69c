"""The JSON Schema takes every shipped pipeline, and refuses what the loader refuses for form."""

from __future__ import annotations

import json
from typing import Any

import jsonschema
import pytest
import yaml

from helpers_cli import DISCS, LOADS, plugin
from tactile_graph import loads
from tactile_graph.errors import PipelineError
from tactile_graph.plugins.registry import Registry, installed
from tactile_graph.schema import pipeline_schema


@pytest.fixture(scope="module")
def registry(tmp_path_factory: pytest.TempPathFactory) -> Registry:
    folder = tmp_path_factory.mktemp("pipelines")
    return Registry([("hand", "hand-made", "1.2", plugin(folder))])


@pytest.fixture(scope="module")
def hand_schema(registry: Registry) -> dict[str, Any]:
    return pipeline_schema(registry)[0]


@pytest.fixture(scope="module")
def shipped_schema() -> dict[str, Any]:
    made, troubles = pipeline_schema(installed())
    assert troubles == []
    return json.loads(json.dumps(made, allow_nan=False))


def errors(schema: dict[str, Any], text: str) -> list[str]:
    validator = jsonschema.Draft202012Validator(schema)
    return [e.message for e in validator.iter_errors(yaml.safe_load(text))]


@pytest.mark.parametrize("which", ["hand", pytest.param("shipped", marks=pytest.mark.slow)])
def test_it_is_a_schema_of_its_draft(which, request):
    jsonschema.Draft202012Validator.check_schema(request.getfixturevalue(f"{which}_schema"))


@pytest.mark.parametrize("name", installed().names("pipelines"))
def test_every_shipped_pipeline_is_valid(shipped_schema, name):
    text = installed().path("pipelines", name).read_text(encoding="utf-8")
    assert errors(shipped_schema, text) == []


RIGHT = {
    "plain": DISCS,
    "several nodes": LOADS,
    "a map of ports, conditions, numbers as names": """
pipeline: 3
source: {step: recording, with: {path: [a.txt, b.txt]}}
conditions: {on: footprint.count > 0, always: true}
nodes:
  footprint: {step: pressed, in: {image: frame}, when: "always"}
  all: {step: merge, in: [footprint, footprint]}
  one: {first_of: [footprint, all]}
  inner: {use: discs, in: frame, with: {footprint.level_v: 0.1}, free: {footprint.level_v: [1]}}
  low: {step: pressed, in: frame, free: {level_v: [0.1, 0.2]}}
outputs: one
""",
}
WRONG = {
    "an unknown key": DISCS + "outptus: [circle]\n",
    "no outputs": DISCS.partition("outputs")[0],
    "no name": DISCS.replace("pipeline: discs", "about2: x").replace("about2: x\n", ""),
    "an unknown step": DISCS.replace("step: disc,", "step: dics,"),
    "an unknown setting": DISCS.replace("level_v", "level_w"),
    "a setting out of range": DISCS.replace("0.5", "-0.5"),
    "a setting of a wrong type": DISCS.replace("0.5", "[1]"),
    "a source as a node": DISCS.replace("step: disc,", "step: made,"),
    "a step as a source": DISCS.replace("step: made", "step: disc"),
    "an unknown setting of the source": DISCS.replace("frames: 4", "frame: 4"),
    "a source's setting out of range": DISCS.replace("frames: 4", "frames: -4"),
    "a missing required setting": DISCS.replace("step: made, with: {frames: 4}", "step: recording"),
    "step and use": DISCS.replace("step: disc,", "step: disc, use: loads,"),
    "neither step nor use": DISCS.replace("step: disc, ", ""),
    "with beside first_of": DISCS.replace("step: disc, in: footprint",
                                          "first_of: [footprint], with: {a: 1}"),
    "an unknown port": DISCS.replace("in: footprint", "in: {mask2: footprint}"),
    "no input": DISCS.replace("in: footprint, ", ""),
    "too many inputs": DISCS.replace("in: footprint", "in: [footprint, footprint]"),
    "a reference that is none": DISCS.replace("in: footprint", "in: foot-print"),
    "a name that is none": DISCS.replace("circle: {", "9circle: {"),
    "a reserved name": DISCS.replace("circle: {", "frame: {"),
    "each that is no yes or no": DISCS.replace("in: footprint", "in: footprint, each: 3"),
    "an output twice": DISCS.replace("[circle]", "[circle, circle]"),
    "a free setting that is none": DISCS.replace("disc, in", "disc, free: {level_v: [1]}, in"),
    "a free setting without a list": DISCS.replace("with: {level_v: 0.5}", "free: {level_v: 0.5}"),
    "a free value out of range": DISCS.replace("with: {level_v: 0.5}", "free: {level_v: [-0.5]}"),
    "free beside first_of": DISCS.replace("step: disc, in: footprint",
                                          "first_of: [footprint], free: {a: [1]}"),
    "an embedded setting without a node": DISCS.replace("step: disc, in: footprint",
                                                        "use: loads, with: {level_v: 1}"),
}  # fmt: skip


@pytest.mark.parametrize("text", RIGHT.values(), ids=RIGHT)
def test_right_files_are_taken(hand_schema, registry, text):
    loads(text, "right.yaml", registry)
    assert errors(hand_schema, text) == []


@pytest.mark.parametrize("text", WRONG.values(), ids=WRONG)
def test_wrong_files_are_refused_by_the_loader_and_by_the_schema(hand_schema, registry, text):
    with pytest.raises(PipelineError):
        loads(text, "wrong.yaml", registry)
    assert errors(hand_schema, text) != []


def test_settings_carry_meaning_type_and_default_for_editors(hand_schema):
    level = hand_schema["$defs"]["pressed.with"]["properties"]["level_v"]
    assert level["description"] == "From where on a cell is on. (float)"
    assert level["default"] == 0.5
    assert level["exclusiveMinimum"] == 0
    steps = hand_schema["$defs"]["node"]["properties"]["step"]
    summary = steps["markdownEnumDescriptions"][steps["enum"].index("disc")]
    assert summary == "Return the circle of the mask's area about its centre."


def test_a_step_that_cannot_be_imported_leaves_its_settings_open(tmp_path):
    lost = {"lost": "tg_no_such_module:lost"}
    registry = Registry([("hand", "hand-made", "1", plugin(tmp_path, steps=lost))])
    schema, troubles = pipeline_schema(registry)
    assert troubles == ["'lost' of plugin 'hand' (package hand-made): cannot import "
                        "tg_no_such_module: No module named 'tg_no_such_module'"]  # fmt: skip
    text = DISCS.replace("step: disc,", "step: lost, with: {anything: 1},")
    assert errors(schema, text) == []
