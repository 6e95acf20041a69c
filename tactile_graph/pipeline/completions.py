"""What may be named in a pipeline file as it stands: nodes for wires, and values for conditions."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from tactile_graph.errors import PipelineError, TactileGraphError
from tactile_graph.pipeline.conditions.comparable import is_scalar
from tactile_graph.pipeline.declaration import Declaration, declare
from tactile_graph.pipeline.document import read_document
from tactile_graph.pipeline.graph import FRAME
from tactile_graph.pipeline.load import parse_graph
from tactile_graph.pipeline.wiring import arms, public_fields, when_known
from tactile_graph.plugins.registry import Registry
from tactile_graph.steps.signature import list_item
from tactile_graph.wires import Frame


class Nameable(NamedTuple):
    """What a file's wires and its conditions may name.

    Attributes
    ----------
    wires : tuple of str
        Its nodes, ``frame`` first, and the outputs of those with several.
    conditions : tuple of str
        Its named conditions; what is a number, a text or a yes or no; and one beginning of a
        condition over items for each field of lists: ``any(contacts.contacts.peak)``.
    """

    wires: tuple[str, ...]
    conditions: tuple[str, ...]


def nameable(text: str, file: str, registry: Registry) -> Nameable:
    """Return what may be named in a file, which need not be right as yet."""
    declared = declare(read_document(text, file))
    types = _types(text, file, registry, declared)
    wires = [wire for name, kind in types.items() for wire in _wires(name, kind)]
    values = [value for name, kind in types.items() for value in _values(name, kind)]
    return Nameable(tuple(wires), (*declared.conditions, *values))


def _types(text: str, file: str, registry: Registry, declared: Declaration) -> Mapping[str, Any]:
    """Return the type of each node; of a file with problems only those that steps tell."""
    try:
        found = parse_graph(text, file, registry).types
        return {name: kind for name, kind in found.items() if "/" not in name}
    except PipelineError:
        types: dict[str, Any] = {FRAME: Frame}
        for node in declared.nodes.values():
            output = _output(node.step or "", file, registry)
            types[node.name] = list[output] if node.each else output  # type: ignore[valid-type]
        return types


def _output(step: str, file: str, registry: Registry) -> Any:
    try:
        return registry.step(step, file).output
    except TactileGraphError:
        return Any


def _wires(name: str, kind: Any) -> Iterator[str]:
    yield name
    for field in getattr(kind, "_fields", ()):
        yield f"{name}.{field}"


def _values(name: str, kind: Any) -> Iterator[str]:
    """Yield what conditions may read of a value: itself, its fields, those of its items."""
    if _is_value(kind):
        yield name
    fields = {} if list_item(kind) is not None else public_fields(kind)
    yield from (f"{name}.{field}" for field, its in fields.items() if _is_value(its))
    lists = {name: kind, **{f"{name}.{field}": its for field, its in fields.items()}}
    for path, its in lists.items():
        item = list_item(when_known(its))
        known = {} if item is None else public_fields(when_known(item))
        yield from (f"any({path}.{field})" for field, of in known.items() if _is_value(of))


def _is_value(kind: Any) -> bool:
    return kind is not Any and all(is_scalar(arm) for arm in arms(when_known(kind)))
