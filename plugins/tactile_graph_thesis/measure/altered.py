"""Pipelines with some of their nodes put otherwise, for what the thesis says of another way."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tactile_graph import Pipeline, load, loads


def altered(pipeline: str, nodes: Mapping[str, Mapping[str, Any] | None]) -> Pipeline:
    """Return a pipeline with nodes added or put in the place of those of the same name.

    Parameters
    ----------
    pipeline : str
        Its name.
    nodes : mapping
        Name -> the node as a file has it; None takes it away.
    """
    import yaml

    data = yaml.safe_load(load(pipeline).text)
    data.pop("evolves", None)
    kept = {name: node for name, node in data["nodes"].items() if name not in nodes}
    added = {name: dict(node) for name, node in nodes.items() if node is not None}
    whole = {**data, "nodes": {**kept, **added}}
    return loads(yaml.safe_dump(whole, sort_keys=False), f"{pipeline}, altered")
