"""Nodes and values as plain data, fit for YAML, JSON and digests."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tactile_graph.pipeline.node import Node, NodeKind


def plain_node(node: Node) -> dict[str, Any]:
    """Return a node as provenance keeps it, every setting spelled out."""
    data: dict[str, Any] = {}
    if node.kind is NodeKind.STEP and node.signature is not None:
        data["step"] = node.signature.name
    elif node.inner is not None:
        data["use"] = node.inner.resolved()
    if node.choices:
        data["first_of"] = [str(c) for c in node.choices]
    if node.inputs:
        data["in"] = {
            b.port.name: [str(r) for r in b.refs] if b.collects else str(b.refs[0])
            for b in node.inputs
        }
    if node.settings:
        data["with"] = plain(node.settings)
    if node.guard is not None:
        data["when"] = node.guard.text
    if node.each:
        data["each"] = True
    return data


def plain(value: Any) -> Any:
    """Return a value as plain data fit for YAML and JSON."""
    if isinstance(value, dict | Mapping):
        return {str(k): plain(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [plain(v) for v in value]
    if isinstance(value, set | frozenset):
        return sorted((plain(v) for v in value), key=repr)  # the same under every hash seed
    if value is None or isinstance(value, bool | int | float | str):
        return value
    if hasattr(value, "tolist"):
        return value.tolist()
    return str(value)
