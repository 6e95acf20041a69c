"""Tables of pipelines and results for terminals and notebooks."""

from __future__ import annotations

import io

import numpy as np
import pytest
from rich.console import Console

from helpers_cli import DISCS, LOADS, plugin
from tactile_graph import Circle, Frame, Pipeline, loads
from tactile_graph.draw.tables import pipeline_table, result_table, summary
from tactile_graph.plugins.registry import Registry


@pytest.fixture
def registry(tmp_path) -> Registry:
    return Registry([("hand", "hand-made", "1.2", plugin(tmp_path))])


def printed(what: object) -> str:
    out = io.StringIO()
    Console(file=out, width=140).print(what)
    return out.getvalue()


def rows(text: str) -> dict[str, str]:
    return {line.split()[0]: " ".join(line.split()) for line in text.splitlines() if line.strip()}


def pressed_frame() -> Frame:
    return Frame.of(np.ones((2, 3)), quantity="volt")


def test_a_pipelines_table_has_each_nodes_step_wires_changed_settings_guard_and_type(registry):
    text = printed(loads(DISCS, "discs.yaml", registry))
    got = rows(text)
    assert text.startswith("discs — A disc on hand-made frames")
    assert got["footprint"] == "footprint pressed frame.image Mask"
    assert got["circle"] == "circle * disc footprint footprint.count > 0 Circle"
    assert "* output; source made" in text


def test_settings_that_differ_from_their_defaults_are_shown(registry):
    pipeline = loads(DISCS, "d.yaml", registry).with_settings({"circle.crash": True})
    assert (
        "circle * disc footprint crash: true footprint.count > 0 Circle"
        in rows(printed(pipeline_table(pipeline))).values()
    )


def test_a_pipeline_without_a_source_says_so(registry):
    text = printed(loads(LOADS, "l.yaml", registry))
    assert "no source, evolves discs" in text


def test_a_results_table_has_states_values_and_reasons(registry):
    pipeline: Pipeline = loads(DISCS, "d.yaml", registry)
    got = rows(printed(pipeline.run(pressed_frame())))
    assert got["footprint"].endswith("Mask 2 x 3, count 6, area 6 cm²")
    assert got["circle"].startswith("circle * disc ran")
    empty = pipeline.run(Frame.of(np.zeros((2, 3)), quantity="volt"))
    assert rows(printed(empty))["circle"] == (
        "circle * disc skipped when footprint.count > 0 is false (footprint.count = 0)"
    )


def test_a_failure_shows_where_and_with_what(registry):
    pipeline = loads(DISCS, "d.yaml", registry).with_settings({"circle.crash": True})
    text = printed(result_table(pipeline.run(pressed_frame())))
    assert "ZeroDivisionError: divided by nothing" in text
    assert "helpers_cli.py" in text
    assert "with Mask 2x3" in text


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (1.23456789, "1.23457"), (True, "True"), (3, "3"), ((), "no items"),
        ((Circle(1.0, 2.0, 0.5),), "1 × Circle: Circle: x 1 cm, y 2 cm, radius 0.5 cm"),
        ((1, 2), "2 × int"), ("x" * 100, "…"), ({"a": 1}, "{'a': 1}"),
    ],
)  # fmt: skip
def test_summaries(value, text):
    assert summary(value) == text
