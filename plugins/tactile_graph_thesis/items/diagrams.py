"""Figures 4.7, 4.14, 4.19, 4.23, 4.29, 4.37: block diagrams, drawn from the pipeline files."""

from __future__ import annotations

from typing import Any

from tactile_graph_thesis.item import Item, Made, Table
from tactile_graph_thesis.work import Work


def _diagram(pipeline: str) -> Any:
    """Return a function that draws a pipeline's graph and lists its nodes."""

    def make(work: Work) -> Made:
        from tactile_graph import load

        loaded = load(pipeline)
        nodes = loaded.resolved()["nodes"]
        rows = [
            (name, node.get("step") or "pipeline", _settings(node)) for name, node in nodes.items()
        ]
        return Made(table=Table(("node", "step", "settings"), rows), svg=loaded.svg())

    return make


def _settings(node: dict[str, Any]) -> str:
    return ", ".join(f"{k} {v}" for k, v in node.get("with", {}).items())


def _item(figure: str, pipeline: str, title: str, why: str = "") -> Item:
    return Item(
        f"figure-{figure}",
        title,
        f"The graph of the pipeline file {pipeline}, which is what runs.",
        _diagram(pipeline),
        why,
    )


ITEMS = (
    _item("4.7", "circle-1", "Blocks of the first circular localisation"),
    _item("4.14", "circle-2", "Blocks of the second circular localisation"),
    _item("4.19", "circle-3", "Blocks of the third circular localisation"),
    _item("4.23", "rectangle-1", "Blocks of the first rectangular localisation"),
    _item("4.29", "rectangle-2", "Blocks of the second rectangular localisation"),
    _item(
        "4.37",
        "identify-locate",
        "Blocks of identification and localisation",
        "The thesis leaves open which features index the objects; weight and area are taken.",
    ),
)
