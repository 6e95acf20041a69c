"""Merge pipelines into one graph in which equal nodes are one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from tactile_graph.api.pipeline import Pipeline
from tactile_graph.engine.plan import Plan, make_plan
from tactile_graph.pipeline.conditions import Guard
from tactile_graph.pipeline.graph import FRAME, Node
from tactile_graph.pipeline.wiring import Ref
from tactile_graph_compare.variants.identity import identities


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
    _refs: dict[Ref, Ref] = field(default_factory=dict, init=False)

    def ref(self, ref: Ref) -> Ref:
        """Return where the merged graph has what the variant reads at ``ref``."""
        found = self._refs.get(ref)
        if found is None:
            found = self._refs[ref] = replace(ref, node=self.names[ref.node])
        return found


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
    for number, (pipeline, wanted) in enumerate(zip(pipelines, asked, strict=True), 1):
        plan = make_plan(pipeline, tuple(wanted))
        always = {plan.items[slot].name for slot in plan.main}
        digests = identities(pipeline, always, number)
        refs = tuple(pipeline.outputs.get(name) or pipeline.ref(name) for name in wanted)
        member = Member(pipeline, plan, {FRAME: FRAME}, refs)
        for item in plan.nodes:
            digest = digests[item.name]
            if digest not in by_identity:
                name = _name(item.name, number, often, taken)
                by_identity[digest] = name
                nodes[name] = _moved(pipeline.nodes[item.name], name, member)
            member.names[item.name] = by_identity[digest]
        outputs |= {f"{number}:{name}": member.ref(r) for name, r in zip(wanted, refs, strict=True)}
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
