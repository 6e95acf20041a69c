"""A pipeline as the page has it."""

from __future__ import annotations

import json
from typing import Annotated, Any, Literal

import numpy as np
import pytest
from annotated_types import Ge, Gt, Le

import tactile_graph as tg
from tactile_graph.steps.signature import Setting
from tactile_graph_live.server.graph_message import graph_message, setting_message
from tactile_graph_live.server.messages import Apart, encoded


def told(annotation: Any, value: Any, name: str = "level_v") -> Any:
    return setting_message(Setting(name, annotation, value), value, "what it is", changed=False)


def test_a_number_has_its_bounds_its_unit_and_a_slider_within_them() -> None:
    setting = told(Annotated[float, Ge(0.0), Le(1.0)], 0.01)
    assert (setting.kind, setting.low, setting.high, setting.unit) == ("number", 0.0, 1.0, "V")
    assert setting.slider_low == 0.0
    assert 0.02 <= setting.slider_high <= 1.0
    assert 0 < setting.step <= 0.01


@pytest.mark.parametrize(
    ("annotation", "value", "kind"),
    [
        (Annotated[int, Ge(1)], 3, "integer"),
        (Annotated[float, Gt(0)] | None, None, "number"),
        (bool, True, "boolean"),
        (Literal["a", "b"], "a", "choice"),
        (str, "word", "text"),
        (list[float], [1.0, 2.0], "text"),
        (dict[str, Any], {"a": 1}, "text"),
        (float | str, 0.5, "text"),
    ],
)
def test_each_kind_of_setting_is_known(annotation: Any, value: Any, kind: str) -> None:
    setting = told(annotation, value)
    assert setting.kind == kind
    json.dumps([setting.value, setting.default, *setting.choices])


@pytest.mark.parametrize("value", [1e308, -1e308, 10**400])
def test_a_number_beyond_all_sliders_has_one_all_the_same(value: float) -> None:
    setting = told(float if isinstance(value, float) else int, value)
    assert setting.value == value
    ends = (setting.slider_low, setting.slider_high, setting.step)
    assert np.isfinite(ends).all()


@pytest.mark.parametrize("value", [0, 1e-9, 1.0, 25.0, 1e6, -3.0])
def test_a_slider_holds_the_value_wherever_it_is(value: float) -> None:
    setting = told(float, value)
    assert setting.slider_low <= value <= setting.slider_high
    assert setting.slider_low < setting.slider_high
    assert 0 < setting.step <= (setting.slider_high - setting.slider_low) / 20


def test_a_graph_is_boxes_wires_settings_and_columns() -> None:
    pipeline = tg.load("circle-3")
    graph = graph_message(pipeline, 7, (pipeline.text, ""), {"footprint": {"level_v": 0.02}})
    assert graph.version == 7
    names = [box.name for box in graph.boxes]
    assert names == ["(source)", "frame", *pipeline.nodes]
    assert {w.start for w in graph.wires} | {w.end for w in graph.wires} <= set(names)
    assert [w for w in graph.wires if w.kind == "guard"]
    changed = [(n.name, s.name) for n in graph.nodes for s in n.settings if s.changed]
    assert changed == [("footprint", "level_v")]
    assert ("radius_cm", "radius", "cm") in [(c.key, c.name, c.unit) for c in graph.columns]


def test_a_column_in_the_pads_unit_has_it_by_the_quantity_of_the_frames() -> None:
    load = tg.loads("pipeline: p\nnodes: {load: {step: load, in: frame}}\noutputs: [load]")
    units = {c.name: c.units for c in graph_message(load, 1, ("", ""), {}).columns}
    assert units["peak"]["kilopascal"] == "kPa"
    assert units["x"] == {}


def test_settings_within_pipelines_that_are_used_are_there_under_their_full_names() -> None:
    pipeline = tg.loads("""
pipeline: nested
nodes:
  cheap: {use: circle-1}
  print: {step: threshold, in: frame, with: {level_v: 0.01}}
  areas: {step: split_contacts, in: [frame, print]}
  each_one: {use: circle-2, in: areas.contacts, each: true}
outputs: [cheap, each_one]
""")
    nodes = {n.name: n for n in graph_message(pipeline, 1, ("", ""), {}).nodes}
    for name in ("cheap/footprint", "each_one/footprint"):
        assert "level_v" in [s.name for s in nodes[name].settings]
        pipeline.with_settings({f"{name}.level_v": 0.03})


def test_nodes_that_run_apart_are_marked_whoever_asked_for_it() -> None:
    pipeline = tg.loads("""
pipeline: careful
isolated: [hull.*]
nodes:
  print: {step: threshold, in: frame, with: {level_v: 0.01}}
  boundary: {step: boundary_scan, in: print}
  free: {step: boundary_scan, in: print, isolated: false}
  circle: {step: fit_circle, in: boundary, time_limit_s: 0.5}
  areas: {step: split_contacts, in: [frame, print]}
  each_one: {use: circle-2, in: areas.contacts, each: true}
outputs: [circle, free, each_one]
""")
    message = graph_message(pipeline, 1, ("", ""), {})
    apart = {n.name: n.apart for n in message.nodes}
    assert apart["boundary"] == apart["each_one/boundary"] == Apart("hull", None)
    assert apart["circle"] == Apart("", 0.5)
    assert [apart[n] for n in ("print", "free", "each_one")] == [None] * 3
    told = {n["name"]: n["apart"] for n in json.loads(encoded(message))["nodes"]}
    assert told["circle"] == {"process": "", "time_limit_s": 0.5}


@pytest.mark.slow
def test_every_shipped_pipeline_goes_as_json() -> None:
    from tactile_graph.plugins.registry import installed

    for name in installed().names("pipelines"):
        pipeline = tg.load(name)
        graph = graph_message(pipeline, 1, (pipeline.text, pipeline.text), {})
        json.loads(encoded(graph), parse_constant=pytest.fail)
        for node in graph.nodes:
            for setting in node.settings:
                if setting.slider_low is not None and setting.value is not None:
                    assert setting.slider_low <= setting.value <= setting.slider_high, (
                        name, node.name, setting.name,
                    )  # fmt: skip
