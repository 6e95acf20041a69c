"""Merge pipelines into one graph in which equal nodes are one."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from tactile_graph import Pipeline
from tactile_graph.inspect import (
    FRAME,
    Graph,
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


@dataclass(frozen=True, eq=False, repr=False)
class _MergedPipeline(Pipeline):
    """A pipeline that no text declares; pickled by what it was merged from.

    Parameters
    ----------
    parts : tuple of (Pipeline, tuple of str)
        Each variant, and what is asked of it.
    """

    parts: tuple[tuple[Pipeline, tuple[str, ...]], ...] = ()

    def __reduce__(self) -> tuple[Callable[..., Pipeline], tuple[Any, ...]]:
        """Pickle the variants, which another process merges again."""
        return _merged_again, (self.parts, tuple(self.nodes))


def _merged_again(
    parts: Sequence[tuple[Pipeline, tuple[str, ...]]], order: Sequence[str]
) -> Pipeline:
    pipeline = merge([p for p, _ in parts], [asked for _, asked in parts]).pipeline
    return replace(pipeline, nodes={name: pipeline.nodes[name] for name in order})


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
    see every frame (`node_digests`). What ran may be more: what one variant needs, another may not.
    """
    merger = _Merger(pipelines)
    members = tuple(
        merger.add(number, pipeline, names)
        for number, (pipeline, names) in enumerate(zip(pipelines, asked, strict=True), 1)
    )
    parts = tuple((p, tuple(names)) for p, names in zip(pipelines, asked, strict=True))
    return Merged(_pipeline(parts, merger.nodes, merger.outputs), members)


class _Merger:
    """The merged nodes so far."""

    def __init__(self, pipelines: Sequence[Pipeline]) -> None:
        self.nodes: dict[str, Node] = {}
        self.outputs: dict[str, Ref] = {}
        self._by_digest: dict[str, str] = {}
        uses = Counter(name for pipeline in pipelines for name in pipeline.nodes)
        self._ambiguous = {name for name, n in uses.items() if n > 1}

    def add(self, number: int, pipeline: Pipeline, asked: Sequence[str]) -> Member:
        """Enter what a demand on a pipeline needs; return its place."""
        plan = make_plan(pipeline, tuple(asked))
        always = {plan.items[slot].name for slot in plan.main}
        digests = node_digests(pipeline, always, number)
        refs = tuple(pipeline.outputs.get(name) or pipeline.ref(name) for name in asked)
        member = Member(pipeline, plan, {FRAME: FRAME}, refs)
        for item in plan.nodes:
            digest = digests[item.name]
            if digest not in self._by_digest:
                name = self._by_digest[digest] = self._name(item.name, number)
                self.nodes[name] = pipeline.nodes[item.name].rewired(name, member.ref)
            member.names[item.name] = self._by_digest[digest]
        for name, ref in zip(asked, refs, strict=True):
            self.outputs[f"{number}:{name}"] = member.ref(ref)
        return member

    def _name(self, own: str, number: int) -> str:
        """Return a name no other merged node has; without dots, which part fields."""
        name = plain = own.replace(".", ":")
        if own in self._ambiguous and name in self.nodes:
            name = f"{plain}@{number}"
        while name in self.nodes:
            name += "'"
        return name


def _pipeline(
    parts: tuple[tuple[Pipeline, tuple[str, ...]], ...],
    nodes: dict[str, Node],
    outputs: dict[str, Ref],
) -> Pipeline:
    first = parts[0][0]
    return _MergedPipeline(
        name=" + ".join(dict.fromkeys(p.name for p, _ in parts)),
        about="",
        evolves="",
        source=first.source,
        nodes=nodes,
        outputs=outputs,
        file="",
        text="nodes: {}\n",  # no file spells anything out; pictures look here for what one did
        registry=first.registry,
        parts=parts,
    )


def node_digests(pipeline: Graph, always: Collection[str], private: object) -> dict[str, str]:
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
        Node name -> digest. Equal are step, settings, guard (spelled out), process, time limit
        and all that is read, down to the frame.

    Notes
    -----
    `Node.key` is made for seeding: it tells a node from the same one inside an embedded pipeline.
    Here such nodes are equal too, unless they take randomness, which is seeded by that very key.
    """
    digests = {FRAME: FRAME}
    for name, node in pipeline.nodes.items():
        own: tuple[object, ...] = ()
        if node.stateful and name not in always:
            own = ("private", private, name)
        digests[name] = node_key(_what(node), _wires(node, digests), own)
    return digests


def _what(node: Node) -> tuple[object, ...]:
    """Return what a node does, apart from what it reads."""
    if node.kind is NodeKind.MAP:
        return ("map", node.name, *_inner(node.inner))
    if node.signature is None:
        return (node.kind.value,)
    seed = node.key if node.signature.rng else ""
    settings = sorted(plain(node.settings).items())
    step = (node.signature.name, id(node.signature.target), node.isolation)
    return ("step", *step, settings, node.each, seed)


def _inner(pipeline: Graph | None) -> tuple[object, ...]:
    """Return what makes two mapped pipelines equal: also their names, which failures carry."""
    assert pipeline is not None
    inner = node_digests(pipeline, pipeline.nodes, "")
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
