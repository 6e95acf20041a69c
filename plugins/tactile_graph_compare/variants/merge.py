"""Merge pipelines into one graph in which equal nodes are one."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from tactile_graph import Pipeline
from tactile_graph.inspect import (
    FRAME,
    Graph,
    Guard,
    Node,
    NodeKind,
    Plan,
    Ref,
    Replay,
    make_plan,
    node_key,
    plain,
)


@dataclass(frozen=True, eq=False)
class Member:
    """A variant's place in the merged graph.

    Parameters
    ----------
    pipeline : Pipeline
    plan : Plan
        What it would run alone for what is asked of it.
    names : dict of str
        Each of its nodes that the demand reaches -> the merged node it is.
    asked : tuple of Ref
        What is asked of it, in its own names.
    """

    pipeline: Pipeline
    plan: Plan
    names: dict[str, str]
    asked: tuple[Ref, ...]

    def ref(self, ref: Ref) -> Ref:
        """Return where the merged graph has what the variant reads at ``ref``."""
        return replace(ref, node=self.names[ref.node])

    @cached_property
    def alone(self) -> Replay:
        """What turns a merged result into the one the variant alone would have given."""
        return Replay(self.plan, self.names)


@dataclass(frozen=True, eq=False)
class Merged:
    """All variants in one pipeline; its outputs are named ``number:output``, from 1."""

    pipeline: Pipeline
    members: tuple[Member, ...]

    def in_order(self, members: Sequence[int]) -> Pipeline:
        """Return the same pipeline with the nodes of its members, by number, in another order."""
        order: dict[str, None] = {}
        for member in (self.members[k] for k in members):
            order |= dict.fromkeys(member.names[i.name] for i in member.plan.nodes)
        nodes = {name: self.pipeline.nodes[name] for name in order}
        return replace(self.pipeline, nodes=nodes)


def merge(pipelines: Sequence[Pipeline], asked: Sequence[Sequence[str]]) -> Merged:
    """Return the graph that computes for every pipeline what is asked of it.

    Parameters
    ----------
    pipelines : sequence of Pipeline
    asked : sequence of sequence of str
        For each, the outputs or nodes asked for.

    Raises
    ------
    UsageError
        If something asked for does not exist.

    Notes
    -----
    What comes out of a variant's nodes is what it alone would have given: a node's outcome is a
    function of the frame and of its state, and steps that keep state are shared only where both
    see every frame (`identity`). What ran may be more: what one variant needs, another may not.
    """
    nodes: dict[str, Node] = {}
    by_identity: dict[str, str] = {}
    taken: set[str] = set()
    often = _often(pipelines)
    members: list[Member] = []
    outputs: dict[str, Ref] = {}
    for number, (pipeline, names) in enumerate(zip(pipelines, asked, strict=True), 1):
        plan = make_plan(pipeline, tuple(names))
        always = {plan.items[slot].name for slot in plan.main}
        digests = identities(pipeline, always, number)
        refs = tuple(pipeline.outputs.get(name) or pipeline.ref(name) for name in names)
        member = Member(pipeline, plan, {FRAME: FRAME}, refs)
        for item in plan.nodes:
            digest = digests[item.name]
            if digest not in by_identity:
                name = _name(item.name, number, often, taken)
                by_identity[digest] = name
                nodes[name] = _moved(pipeline.nodes[item.name], name, member)
            member.names[item.name] = by_identity[digest]
        outputs |= {f"{number}:{name}": member.ref(r) for name, r in zip(names, refs, strict=True)}
        members.append(member)
    return Merged(_pipeline(pipelines, nodes, outputs), tuple(members))


def _often(pipelines: Sequence[Pipeline]) -> set[str]:
    """Return the names that more than one pipeline uses."""
    seen: set[str] = set()
    often: set[str] = set()
    for pipeline in pipelines:
        often |= seen & set(pipeline.nodes)
        seen |= set(pipeline.nodes)
    return often


def _name(own: str, number: int, often: set[str], taken: set[str]) -> str:
    """Return a name no other merged node has; without dots, which part fields."""
    name = plain = own.replace(".", ":")
    if own in often and name in taken:
        name = f"{plain}@{number}"
    while name in taken:
        name += "'"
    taken.add(name)
    return name


def _moved(node: Node, name: str, member: Member) -> Node:
    guard = node.guard
    if guard is not None:
        refs = tuple(member.ref(r) for r in guard.refs)
        guard = Guard(guard.text, refs, guard.function, guard.meaning)
    return replace(
        node,
        name=name,
        inputs=tuple(replace(b, refs=tuple(member.ref(r) for r in b.refs)) for b in node.inputs),
        choices=tuple(member.ref(c) for c in node.choices),
        guard=guard,
    )


def _pipeline(
    pipelines: Sequence[Pipeline], nodes: dict[str, Node], outputs: dict[str, Ref]
) -> Pipeline:
    first = pipelines[0]
    return Pipeline(
        name=" + ".join(dict.fromkeys(p.name for p in pipelines)),
        about="",
        evolves="",
        source=first.source,
        nodes=nodes,
        outputs=outputs,
        file="",
        text="nodes: {}\n",  # no file spells anything out; pictures look here for what one did
        registry=first.registry,
    )


def identities(pipeline: Graph, always: Collection[str], private: object) -> dict[str, str]:
    """Return a digest for each node, equal for nodes that may be run as one.

    Parameters
    ----------
    pipeline : Graph
    always : collection of str
        Nodes that are settled for every frame, whatever the frame holds. A step that keeps state
        is shared only among these: one that a guard or an earlier choice keeps from some frames
        would otherwise see frames that it alone never sees.
    private : object
        Goes into the digests of what is not shared.

    Returns
    -------
    dict of str
        Node name -> digest. Equal are step, settings, guard (spelled out) and all that is read,
        down to the frame.
    """
    found = {FRAME: FRAME}
    for name, node in pipeline.nodes.items():
        own: tuple[object, ...] = ()
        if node.stateful and name not in always:
            own = ("private", private, name)
        found[name] = node_key(_what(node), _wires(node, found), own)
    return found


def _what(node: Node) -> tuple[object, ...]:
    """Return what a node does, apart from what it reads."""
    if node.kind is NodeKind.MAP:
        return ("map", node.name, *_inner(node.inner))
    if node.signature is None:
        return (node.kind.value,)
    seed = node.key if node.signature.rng else ""
    settings = sorted(plain(node.settings).items())
    return ("step", node.signature.name, id(node.signature.target), settings, node.each, seed)


def _inner(pipeline: Graph | None) -> tuple[object, ...]:
    """Return what makes two mapped pipelines equal: also their names, which failures carry."""
    assert pipeline is not None
    inner = identities(pipeline, pipeline.nodes, "")
    return (pipeline.resolved()["nodes"], inner, list(pipeline.outputs.items()), pipeline.key)


def _wires(node: Node, found: dict[str, str]) -> tuple[object, ...]:
    def one(ref: Ref) -> Any:
        return (found[ref.node], ref.path, ref.item_path)

    guard = node.guard
    return (
        None if guard is None else (guard.meaning, [one(r) for r in guard.refs]),
        [(b.port.name, b.collects, b.iterates, [one(r) for r in b.refs]) for b in node.inputs],
        [one(r) for r in node.choices],
    )
