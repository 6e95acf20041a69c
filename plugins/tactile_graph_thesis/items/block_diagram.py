"""Block diagrams, drawn from the pipeline files: figures 4.7, 4.14, 4.19, 4.23, 4.29 and 4.37."""

from __future__ import annotations

from typing import Any

from tactile_graph import load
from tactile_graph_thesis.item import Item, Made, Table
from tactile_graph_thesis.work import Work


def block_diagram(figure: str, pipeline: str, title: str, why: str = "") -> Item:
    """Return the item that draws a pipeline's graph and lists its nodes.

    Parameters
    ----------
    figure : str
        Its number.
    pipeline, title, why : str
    """

    def make(_: Work) -> Made:
        loaded = load(pipeline)
        nodes = loaded.resolved()["nodes"]
        rows = [
            (name, node.get("step") or "pipeline", _settings(node)) for name, node in nodes.items()
        ]
        return Made(table=Table(("node", "step", "settings"), rows), svg=loaded.svg())

    shows = f"The graph of the pipeline file {pipeline}, which is what runs."
    return Item(f"figure-{figure}", title, shows, make, why)


def _settings(node: dict[str, Any]) -> str:
    return ", ".join(f"{k} {v}" for k, v in node.get("with", {}).items())
