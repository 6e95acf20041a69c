"""Pipelines that a file uses put into it node by node, so that what guards them may be chosen."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from tactile_graph import load
from tactile_graph.inspect import FRAME, named_from
from tactile_graph.pipeline.document import read_document
from tactile_graph.plugins.registry import Registry

Data = dict[str, Any]
Renamed = Callable[[str], str]
_WORD = re.compile(r"'[^']*'|\"[^\"]*\"|(?<![\w.])[A-Za-z_]\w*")
"""A quoted text, or the name at the root of a reference."""


def expanded(data: Data, file: str, registry: Registry) -> Data:
    """Return a file's data with the pipelines it uses in the place of their nodes.

    Parameters
    ----------
    data : dict
        Of a file that has been found right.
    file : str
        Where it stands: files it names lie beside it.
    registry : Registry

    Notes
    -----
    The node keeps its name and its guard, and hands on the output as a ``first_of`` of one; nodes
    within are called ``node_inner``. What is run for each item of a list, what reads something
    other than the frame, and what has several outputs stays as it is.
    """
    nodes: Data = {}
    conditions: Data = dict(data.get("conditions") or {})
    for name, node in data["nodes"].items():
        inner = _inner(node, file, registry)
        if inner is None:
            nodes[name] = node
            continue
        renamed = _renamer(name, inner, {*data["nodes"], *conditions})
        conditions |= {renamed(c): _moved(t, renamed) for c, t in inner["conditions"].items()}
        nodes |= {renamed(n): _node(x, renamed) for n, x in inner["nodes"].items()}
        (output,) = inner["outputs"]
        nodes[name] = {"first_of": [_moved(output, renamed)]}
        if "when" in node:
            nodes[name]["when"] = node["when"]
    found = {**data, "nodes": nodes}
    return {**found, "conditions": conditions} if conditions else found


def _inner(node: Mapping[str, Any], file: str, registry: Registry) -> Data | None:
    """Return the data of the pipeline that a node uses, as it stands here; None to leave it."""
    if "use" not in node or node.get("each") or node.get("in") not in (None, FRAME, {FRAME: FRAME}):
        return None
    beside = Path(file).parent / node["use"]
    named = node["use"].endswith((".yaml", ".yml")) and beside.exists()
    used = load(beside if named else node["use"], registry)
    data = read_document(used.text, used.file).data
    outputs = data["outputs"] if isinstance(data["outputs"], list) else [data["outputs"]]
    if len(outputs) != 1:
        return None
    for name, value in (node.get("with") or {}).items():
        inner, _, setting = name.rpartition(".")
        if inner not in data["nodes"]:  # of a pipeline deeper within, which stays as it is then
            return None
        its = data["nodes"][inner]
        its["with"] = {**(its.get("with") or {}), setting: value}
    data = {"conditions": {}, **data, "outputs": outputs}
    found = {"conditions": {}, **expanded(data, used.file, registry)}
    for its in found["nodes"].values():
        if "use" in its:
            its["use"] = named_from(its["use"], used.file, file)
    return found


def _renamer(name: str, inner: Data, taken: set[str]) -> Renamed:
    own = {*inner["nodes"], *inner["conditions"]}
    prefix = f"{name}_"
    while any(prefix + n in taken for n in own):
        prefix += "_"
    return lambda word: prefix + word if word in own else word


def _node(node: Mapping[str, Any], renamed: Renamed) -> Data:
    read = {k: _moved(node[k], renamed) for k in ("in", "first_of", "when") if k in node}
    return {**{k: v for k, v in node.items() if k != "free"}, **read}


def _moved(value: Any, renamed: Renamed) -> Any:
    """Return references, or an expression of them, with the nodes' new names."""
    if isinstance(value, Mapping):
        return {k: _moved(v, renamed) for k, v in value.items()}
    if isinstance(value, list):
        return [_moved(v, renamed) for v in value]
    return _WORD.sub(lambda m: renamed(m[0]), value) if isinstance(value, str) else value
