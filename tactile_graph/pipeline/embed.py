"""Put a pipeline into another: inlined node by node, or run over the items of a list."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from tactile_graph.errors import Mark
from tactile_graph.pipeline.conditions import Guard
from tactile_graph.pipeline.facts import embedded_facts, frame_facts, ref_facts
from tactile_graph.pipeline.graph import FRAME, Binding, Facts, Graph, Node, NodeKind
from tactile_graph.pipeline.wiring import Ref, fit
from tactile_graph.steps.signature import Port, list_item, type_name
from tactile_graph.wires.frame import Frame
from tactile_graph.wires.image import Image


@dataclass(frozen=True)
class Embedding:
    """The node that stands for a pipeline in another: what it reads, of which type, and when.

    ``facts`` are those of what it reads.
    """

    name: str
    mark: Mark
    ref: Ref
    kind: Any
    facts: Facts
    guard: Guard | None


def inline_nodes(inner: Graph, at: Embedding) -> tuple[list[Node], list[str]]:
    """Return the inner nodes under ``name/…`` and one passing node per output, and troubles."""
    rename, troubles = _renamer(at.name, at.ref, at.kind)
    nodes = [
        replace(
            node.rewired(f"{at.name}/{node.name}", rename),
            facts=embedded_facts(node.facts, at.facts),
        )
        for node in inner.nodes.values()
    ]
    single = len(inner.outputs) == 1
    for output, source in inner.outputs.items():
        nodes.append(
            Node(
                at.name if single else f"{at.name}.{output.replace('.', '_')}",
                NodeKind.PASS,
                inner.type_of(source),
                at.mark,
                choices=(rename(source),),
                guard=at.guard,
                key=inner.key + output,
                facts=embedded_facts(_facts_at(source, inner), at.facts),
            )
        )
    return nodes, troubles


def _facts_at(ref: Ref, inner: Graph) -> Facts:
    known = {FRAME: frame_facts(), **{name: node.facts for name, node in inner.nodes.items()}}
    return ref_facts(ref, known)


def _renamer(name: str, ref: Ref, kind: Any) -> tuple[Callable[[Ref], Ref], list[str]]:
    troubles: list[str] = []
    image = fit(ref, kind, Image)

    def rename(inner: Ref) -> Ref:
        if inner.node != FRAME:
            return replace(inner, node=f"{name}/{inner.node}")
        if kind is Frame:
            return Ref(ref.node, (*ref.path, *inner.path), inner.item_path)
        if inner.path[:1] == ("image",) and image is not None:
            return Ref(image.node, (*image.path, *inner.path[1:]), inner.item_path)
        text = f"the pipeline reads {inner}, but {ref} is a {type_name(kind)}"
        if text not in troubles:
            troubles.append(text)
        return Ref(ref.node, ref.path)

    return rename, troubles


def map_node(inner: Graph, at: Embedding) -> tuple[Node, str]:
    """Return a node that runs the inner pipeline over each item, and what is wrong with it."""
    trouble = ""
    fitted = fit(at.ref, at.kind, list[Image])
    if fitted is None:
        hint = "" if list_item(at.kind) is not None else " ('each' needs a list)"
        trouble = f"{at.ref} is a {type_name(at.kind)}, a list of images is needed{hint}"
        fitted = at.ref
    stateful = [n.name for n in inner.nodes.values() if n.stateful]
    if stateful:
        trouble = f"stateful node {stateful[0]!r} of {inner.name!r} cannot run for each item"
    binding = Binding(Port(FRAME, list[Image]), (fitted,))
    node = Node(
        at.name, NodeKind.MAP, _map_output(at.name, inner), at.mark, inputs=(binding,),
        guard=at.guard, each=True, inner=inner, facts=Facts(dict.fromkeys(at.facts.by_frame, "")),
    )  # fmt: skip
    return node, trouble


def _map_output(name: str, inner: Graph) -> Any:
    kinds = {n.replace(".", "_"): inner.type_of(r) for n, r in inner.outputs.items()}
    if len(kinds) == 1:
        return list[next(iter(kinds.values()))]  # type: ignore[misc]
    fields = [(n, list[k]) for n, k in kinds.items()]  # type: ignore[valid-type]
    return NamedTuple(f"{name}_outputs", fields)
