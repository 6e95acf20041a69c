"""The thesis' own pipelines, node by node: each setting against a literal copy of it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml

from tactile_graph import load
from tactile_graph_mrf.energy.model import Model

LITERAL: dict[str, dict[str, Any]] = yaml.safe_load(
    (Path(__file__).parent / "settings_of_the_thesis.yaml").read_text(encoding="utf-8")
)
THESIS = (
    *("circle-1", "circle-2", "circle-3", "rectangle-1", "rectangle-2", "thesis-smooth"),
    *("thesis-lines", "thesis-circle", "thesis-rectangle", "thesis-identify"),
)
POTENTIALS = {"end": 2.7, "straight": 0.9, "corner": 1.8, "tee": 1.8, "cross": 2.7}
"""Figure 5.7's, as ascribed to Geman and Geman; no line costs nothing."""


def plain(value: Any) -> Any:
    """Return tuples as YAML has them."""
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, dict):
        return {key: plain(item) for key, item in value.items()}
    return value


def test_the_literals_are_of_every_pipeline_of_the_thesis() -> None:
    assert tuple(LITERAL) == THESIS


@pytest.mark.parametrize("name", THESIS)
def test_every_setting_is_the_literal_one(name: str) -> None:
    nodes = load(name).resolved()["nodes"]
    assert list(nodes) == list(LITERAL[name])
    for node, declared in nodes.items():
        assert plain(declared) == LITERAL[name][node], node


def test_lines_cost_what_figure_5_7_says() -> None:
    model = Model()
    assert {name: getattr(model, name) for name in POTENTIALS} == POTENTIALS
    for name in ("thesis-lines", "thesis-circle", "thesis-rectangle"):
        costs = LITERAL[name]["restored"]["with"]["model"]
        assert all(f" {pattern}={cost}," in costs for pattern, cost in POTENTIALS.items())
