"""What makes nodes of different pipelines one: they give the same for every frame there can be.

`Node.key` is made for seeding: it tells a node from the same one inside an embedded pipeline. Here
such nodes are equal too, unless they take randomness, which is seeded by that very key.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

from tactile_graph.pipeline.graph import FRAME, Graph, Node, NodeKind, node_key
from tactile_graph.pipeline.plain import plain
from tactile_graph.pipeline.wiring import Ref


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
