"""Put a pipeline into another: inlined node by node, or run over the items of a list."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

from tactile_graph.errors import Mark
from tactile_graph.pipeline.conditions.conditions import Guard
from tactile_graph.pipeline.graph import FRAME, Binding, Facts, Graph, Node, NodeKind
from tactile_graph.pipeline.resolution.facts import embedded_facts, frame_facts, ref_facts
from tactile_graph.pipeline.wiring import Ref, fit
from tactile_graph.steps.signature import Port, list_item, type_name
from tactile_graph.wires.frame import Frame
from tactile_graph.wires.image import Image, Mask

MASK = "mask"
"""The port by which the cells of each item come to a pipeline that reads ``frame.mask``."""


@dataclass(frozen=True)
class Given:
    """A value that is wired to an embedded pipeline: where it is, its type, what is known of it."""

    ref: Ref
    kind: Any
    facts: Facts


@dataclass(frozen=True)
class Embedding:
    """The node that stands for a pipeline in another: what it reads, and when.

    ``frame`` takes the place of the pipeline's frame, each of ``given`` that of one of its nodes.
    """

    name: str
    mark: Mark
    frame: Given
    guard: Guard | None
    given: Mapping[str, Given] = field(default_factory=dict)


def replaced_nodes(inner: Graph, given: Collection[str]) -> set[str]:
    """Return the nodes that values take the place of, and those that only these need.

    With those go the nodes that read one of them though no output needs what they give.
    """
    if not given:
        return set()
    needed = _reached(inner, given)
    gone = _reached(inner, ()) - needed
    for name, node in inner.nodes.items():  # each stands after what it reads
        if name not in needed and any(r.node in gone - {*given} for r in node.wires()):
            gone.add(name)
    return {*given, *gone}


def _reached(inner: Graph, closed: Collection[str]) -> set[str]:
    """Return the nodes that a pipeline's outputs need, not looking behind closed ones."""
    found = set[str]()
    waiting = [ref.node for ref in inner.outputs.values()]
    while waiting:
        name = waiting.pop()
        if name in inner.nodes and name not in found:
            found.add(name)
            waiting += [] if name in closed else [r.node for r in inner.nodes[name].wires()]
    return found


def given_troubles(inner: Graph, at: Embedding) -> Iterator[tuple[str, str]]:
    """Yield each node that a value cannot stand for as it is, and why."""
    for name, value in at.given.items():
        node = inner.nodes[name]
        own = embedded_facts(node.facts, at.frame.facts)
        here, there = value.facts.by_frame, own.by_frame
        pairs = {(here[q], there[q]) for q in here if q in there}
        if pairs and all(a and b and a != b for a, b in pairs):
            got, wanted = sorted(pairs)[0]
            yield name, f"{value.ref} is in {got}, {name} in {wanted}"
        if None not in (value.facts.grid, own.grid) and value.facts.grid != own.grid:
            yield name, f"{value.ref} has another grid than {name}"


def inline_nodes(inner: Graph, at: Embedding) -> tuple[list[Node], list[str]]:
    """Return the inner nodes under ``name/…`` and one passing node per output, and troubles."""
    rename, troubles = _renamer(inner, at)
    gone = replaced_nodes(inner, at.given)
    nodes = [
        replace(
            node.rewired(f"{at.name}/{node.name}", rename),
            facts=embedded_facts(node.facts, at.frame.facts),
        )
        for node in inner.nodes.values()
        if node.name not in gone
    ]
    single = len(inner.outputs) == 1
    for output, source in inner.outputs.items():
        nodes.append(
            Node(
                at.name if single else f"{at.name}.{field_of(output)}",
                NodeKind.PASS,
                inner.type_of(source),
                at.mark,
                choices=(rename(source),),
                guard=at.guard,
                key=inner.key + output,
                facts=embedded_facts(_facts_at(source, inner), at.frame.facts),
            )
        )
    return nodes, troubles


def field_of(output: str) -> str:
    """Return what an embedded pipeline's output is called as a field of the node it stands for."""
    return output.replace(".", "_")


def _facts_at(ref: Ref, inner: Graph) -> Facts:
    known = {FRAME: frame_facts(), **{name: node.facts for name, node in inner.nodes.items()}}
    return ref_facts(ref, known)


def _renamer(inner: Graph, at: Embedding) -> tuple[Callable[[Ref], Ref], list[str]]:
    troubles: list[str] = []
    ref, kind = at.frame.ref, at.frame.kind
    views = {"image": fit(ref, kind, Image), "mask": fit(ref, kind, Mask)}
    stands = {name: _fitted(inner, name, value, troubles) for name, value in at.given.items()}

    def rename(read: Ref) -> Ref:
        if read.node in stands:
            new = stands[read.node]
            return Ref(new.node, (*new.path, *read.path), read.item_path or new.item_path)
        if read.node != FRAME:
            return replace(read, node=f"{at.name}/{read.node}")
        if kind is Frame:
            return Ref(ref.node, (*ref.path, *read.path), read.item_path)
        view = views.get(read.path[0]) if read.path else None
        if view is not None:
            return Ref(view.node, (*view.path, *read.path[1:]), read.item_path)
        text = f"the pipeline reads {read}, but {ref} is a {type_name(kind)}"
        if text not in troubles:
            troubles.append(text)
        return Ref(ref.node, ref.path)

    return rename, troubles


def _fitted(inner: Graph, name: str, value: Given, troubles: list[str]) -> Ref:
    """Return how a value takes the place of a node; where it cannot, that is a trouble."""
    wanted = inner.nodes[name].output
    fitted = fit(value.ref, value.kind, wanted)
    if fitted is None:
        text = f"{value.ref} is a {type_name(value.kind)}, but stands for"
        troubles.append(f"{text} {name!r}, a {type_name(wanted)}")
    return value.ref if fitted is None else fitted


def map_node(inner: Graph, at: Embedding) -> tuple[Node, list[str]]:
    """Return a node that runs the inner pipeline over each item, and what is wrong with it."""
    troubles: list[str] = []
    bindings = [_frame_binding(at, troubles)]
    reads_mask = any(ref.node == FRAME and ref.path[:1] == ("mask",) for ref in _all_reads(inner))
    masks = fit(at.frame.ref, at.frame.kind, list[Mask])
    if reads_mask and masks is not None:
        bindings.append(Binding(Port(MASK, list[Mask]), (masks,), iterates=True))
    for name, value in at.given.items():
        wanted = inner.nodes[name].output
        whole = fit(value.ref, value.kind, wanted)
        each = None if whole else fit(value.ref, value.kind, list[wanted])  # type: ignore[valid-type]
        found = each or whole or _fitted(inner, name, value, troubles)
        bindings.append(Binding(Port(name, wanted), (found,), iterates=each is not None))
    if not troubles and not any(b.iterates for b in bindings):
        troubles.append(f"{at.frame.ref} is a {type_name(at.frame.kind)} ('each' needs a list)")
    stateful = [n.name for n in inner.nodes.values() if n.stateful]
    if stateful:
        troubles = [f"stateful node {stateful[0]!r} of {inner.name!r} cannot run for each item"]
    node = Node(
        at.name, NodeKind.MAP, _map_output(at.name, inner), at.mark, inputs=tuple(bindings),
        guard=at.guard, each=True, inner=_with_given(inner, at),
        facts=Facts(dict.fromkeys(at.frame.facts.by_frame, "")),
    )  # fmt: skip
    return node, troubles


def _frame_binding(at: Embedding, troubles: list[str]) -> Binding:
    """Return what becomes the inner frames: the items of a list of images, or one for all."""
    ref, kind = at.frame.ref, at.frame.kind
    each = fit(ref, kind, list[Image])
    one = fit(ref, kind, Image) if each is None and at.given else None
    if each is None and one is None:
        hint = "" if list_item(kind) is not None else " ('each' needs a list)"
        troubles.append(f"{ref} is a {type_name(kind)}, a list of images is needed{hint}")
    return Binding(Port(FRAME, list[Image]), (each or one or ref,), iterates=one is None)


def _all_reads(inner: Graph) -> list[Ref]:
    return [*inner.outputs.values(), *(r for node in inner.nodes.values() for r in node.wires())]


def _with_given(inner: Graph, at: Embedding) -> Graph:
    """Return the inner pipeline with the nodes that values take the place of left open."""
    if not at.given:
        return inner
    gone = replaced_nodes(inner, at.given)
    nodes = {
        name: Node(name, NodeKind.GIVEN, node.output, node.mark, facts=node.facts, key=node.key)
        if name in at.given
        else node
        for name, node in inner.nodes.items()
        if name in at.given or name not in gone
    }
    rules = tuple(rule for rule in inner.frame_rules if rule.node not in gone)
    return replace(inner, nodes=nodes, frame_rules=rules)


def _map_output(name: str, inner: Graph) -> Any:
    kinds = {field_of(n): inner.type_of(r) for n, r in inner.outputs.items()}
    if len(kinds) == 1:
        return list[next(iter(kinds.values()))]  # type: ignore[misc]
    fields = [(n, list[k]) for n, k in kinds.items()]  # type: ignore[valid-type]
    return NamedTuple(f"{name}_outputs", fields)
