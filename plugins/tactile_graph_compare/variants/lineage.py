"""What one pipeline did to the one it evolved from, node by node."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import fields, is_dataclass
from typing import Any

from tactile_graph import Pipeline
from tactile_graph.inspect import Guard, Node, plain
from tactile_graph_compare.records.comparison import NodeChange, SettingChange
from tactile_graph_compare.records.frames import ChosenFrame, DifferenceImage


def changes_of(parent: Node, child: Node) -> tuple[SettingChange, ...]:
    """Return what of a node is another in the child: step, settings, inputs, guard."""
    before, after = _told(parent), _told(child)
    found = [
        SettingChange(what, before.get(what), after.get(what))
        for what in dict.fromkeys([*before, *after])
        if before.get(what) != after.get(what)
    ]
    if before.get("step") != after.get("step"):  # settings of another step say nothing here
        return tuple(c for c in found if c.what in _OUTSIDE)
    return tuple(found)


_OUTSIDE = ("step", "use", "first of", "each", "in", "when")


def _told(node: Node) -> dict[str, Any]:
    """Return all that makes a node, in words: its wires as the file has them."""
    told: dict[str, Any] = {}
    if node.signature is not None:
        told["step"] = node.signature.name
    if node.inner is not None:
        told["use"] = node.inner.name
    if node.choices:
        told["first of"] = ", ".join(str(c) for c in node.choices)
    if node.each:
        told["each"] = True
    wires = [(b.port.name, ", ".join(str(r) for r in b.refs)) for b in node.inputs]
    if wires:
        told["in"] = (
            wires[0][1] if len(wires) == 1 else ", ".join(f"{p}: {refs}" for p, refs in wires)
        )
    if node.guard is not None:
        told["when"] = node.guard.text
    return told | {k: v for name, of in node.settings.items() for k, v in _fields_of(name, of)}


def _fields_of(name: str, setting: Any) -> Iterator[tuple[str, Any]]:
    """Yield a setting; of a record every field, by name and field."""
    if is_dataclass(setting) and not isinstance(setting, type):
        for field in fields(setting):
            yield from _fields_of(f"{name}.{field.name}", getattr(setting, field.name))
    else:
        yield name, plain(setting)


def nodes_between(
    parent: Pipeline, child: Pipeline
) -> tuple[tuple[str, ...], tuple[str, ...], tuple[NodeChange, ...], tuple[str, ...]]:
    """Return the nodes that were added, removed and changed, and those kept as they were."""
    added = tuple(n for n in child.nodes if n not in parent.nodes)
    removed = tuple(n for n in parent.nodes if n not in child.nodes)
    changed, kept = [], []
    for name, node in child.nodes.items():
        if name not in parent.nodes:
            continue
        changes = changes_of(parent.nodes[name], node)
        if not changes and not _same_meaning(parent.nodes[name], node):
            before, after = parent.nodes[name].guard, node.guard
            assert before is not None
            assert after is not None
            changes = (SettingChange("when", spelled_out(before), spelled_out(after)),)
        if changes:
            changed.append(NodeChange(name, changes))
        else:
            kept.append(name)
    return added, removed, tuple(changed), tuple(kept)


def spelled_out(guard: Guard) -> str:
    """Return a guard with its named conditions spelled out."""
    return re.sub(r"\bv(\d+)\b", lambda m: guard.refs[int(m[1])].spelled, guard.meaning)


def _same_meaning(parent: Node, child: Node) -> bool:
    """Return whether guards of equal words mean the same: named conditions may not."""
    before, after = parent.guard, child.guard
    if before is None or after is None:
        return True
    return (before.meaning, before.refs) == (after.meaning, after.refs)


def difference_images(
    parent: str, child: str, nodes: Sequence[str], frames: Iterable[ChosenFrame]
) -> tuple[DifferenceImage, ...]:
    """Return for the chosen frames the images of two variants' equally named nodes that differ."""
    found = (f.difference(node, parent, child) for f in frames for node in nodes)
    return tuple(d for d in found if d is not None and d.n_changed)
