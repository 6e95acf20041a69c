"""What a drawing of a pipeline shows: a block for each node, a wire for each thing it reads."""

from __future__ import annotations

from collections.abc import Iterator, Set
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

from tactile_graph.pipeline.graph import FRAME, Graph, Node, NodeKind
from tactile_graph.pipeline.wiring import Ref, arms

SOURCE = "(source)"
"""Key of the source's block; brackets keep it apart from every node's name."""

Role = Literal["source", "frame", "step", "choice"]
WireKind = Literal["data", "guard", "choice"]

_MOST_SETTINGS = 3
_LONGEST_VALUE = 22


@dataclass(frozen=True)
class Block:
    """One box: what stands in it, and what more there is to know."""

    key: str
    title: str
    step: str
    role: Role
    settings: tuple[str, ...] = ()
    guard: str = ""
    outputs: tuple[str, ...] = ()
    each: bool = False
    unused: bool = False
    detail: str = ""


@dataclass(frozen=True)
class Wire:
    """One line between two blocks; ``label`` is the field and the port, or a choice's rank."""

    start: str
    end: str
    kind: WireKind
    label: str = ""


def blocks(pipeline: Graph) -> list[Block]:
    """Return the source, the frame and the nodes in the order of the file."""
    found = []
    unused, said = set(pipeline.unused), _said(pipeline)
    if pipeline.source is not None:
        source = pipeline.source
        shown = _settings(source.settings, _defaults(source.signature), said.get(SOURCE, set()))
        found.append(
            Block(SOURCE, "source", source.name, "source", shown, detail=source.signature.summary)
        )
    kept = _outputs_of(pipeline, FRAME)
    found.append(Block(FRAME, FRAME, "", "frame", outputs=kept, detail="what the source gives"))
    found += [
        _block(pipeline, node, node.name in unused, said.get(node.name, set()))
        for node in pipeline.nodes.values()
    ]
    return found


def _block(pipeline: Graph, node: Node, unused: bool, said: Set[str]) -> Block:
    choice = node.kind is NodeKind.FIRST_OF
    step = "first of" if choice else "hands on" if node.kind is NodeKind.PASS else node.what
    shown = _settings(node.settings, _defaults(node.signature), said)
    every = [f"{k} = {_value(v, 200)}" for k, v in node.settings.items()]
    summary = node.signature.summary if node.signature else ""
    return Block(
        node.name,
        node.name,
        step,
        "choice" if choice else "step",
        shown,
        f"when {node.guard.text}" if node.guard else "",
        _outputs_of(pipeline, node.name),
        node.each,
        unused,
        "\n".join(t for t in (f"{node.name}: {node.what}", summary, *every) if t),
    )


def _outputs_of(pipeline: Graph, name: str) -> tuple[str, ...]:
    return tuple(o for o, ref in pipeline.outputs.items() if ref.node == name)


def _defaults(signature: Any) -> dict[str, Any]:
    return {s.name: s.default for s in signature.settings} if signature else {}


def _said(pipeline: Graph) -> dict[str, set[str]]:
    """Return the settings that the file, or who overrode it, spelled out for each node."""
    import yaml

    tree = yaml.safe_load(pipeline.text)
    declared = {**tree["nodes"], SOURCE: tree.get("source")}
    said = {str(n): _keys(d.get("with")) for n, d in declared.items() if isinstance(d, dict)}
    if pipeline.source_override is not None:
        said[SOURCE] = set(pipeline.source_override[1])
    for name, settings in pipeline.overrides.items():
        said[name] = said.get(name, set()) | set(settings)
    return said


def _keys(settings: Any) -> set[str]:
    return {str(k) for k in settings} if isinstance(settings, dict) else set()


def _settings(
    given: dict[str, Any], defaults: dict[str, Any], said: Set[str] = frozenset()
) -> tuple[str, ...]:
    """Return the settings worth a line: those spelled out, and those that are not the default."""
    shown = [
        f"{k} = {_value(v)}"
        for k, v in given.items()
        if k in said or not _same(v, defaults.get(k, ...))
    ]
    more = len(shown) - _MOST_SETTINGS
    if more <= 0:
        return tuple(shown)
    return (*shown[: _MOST_SETTINGS - 1], f"and {more + 1} more settings")


def _same(a: Any, b: Any) -> bool:
    return type(a) is type(b) and repr(a) == repr(b)


def _value(value: Any, longest: int = _LONGEST_VALUE) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, list) and value and all(isinstance(v, Path) for v in value):
        value = ", ".join(map(str, value))
    text = f"{value:.6g}" if isinstance(value, float) else " ".join(str(value).split())
    return text if len(text) <= longest else text[: longest - 1] + "…"


def wires(pipeline: Graph) -> list[Wire]:
    """Return every wire, in the order of the file; what two ports read off one node is one."""
    found: dict[tuple[str, str, WireKind], list[str]] = {}
    if pipeline.source is not None:
        found[SOURCE, FRAME, "data"] = []
    for node in pipeline.nodes.values():
        for ref, kind, label in _reads(pipeline, node):
            labels = found.setdefault((ref.node, node.name, kind), [])
            if label and label not in labels:
                labels.append(label)
    return [Wire(*key, ", ".join(labels)) for key, labels in found.items()]


def _reads(pipeline: Graph, node: Node) -> Iterator[tuple[Ref, WireKind, str]]:
    several = node.signature is not None and len(node.signature.ports) > 1
    for binding in node.inputs:
        for ref in binding.refs:
            parts = [_field(pipeline, ref), binding.port.name if several else ""]
            yield ref, "data", " → ".join(p for p in parts if p)
    for rank, ref in enumerate(node.choices, 1):
        if node.kind is NodeKind.FIRST_OF:
            yield ref, "choice", str(rank)
        else:
            yield ref, "data", _field(pipeline, ref)
    for ref in node.guard.refs if node.guard else ():
        yield ref, "guard", ""


def _field(pipeline: Graph, ref: Ref) -> str:
    """Return the field a wire takes, but for a view that the engine takes by itself."""
    path = list(ref.path)
    views = {v for arm in arms(pipeline.types[ref.node]) for v in _views(arm)}
    if len(path) == 1 and path[0] in views:
        path.pop()
    return ".".join(path)


def _views(kind: Any) -> list[str]:
    return list(getattr(kind, "provides", {}).values())
