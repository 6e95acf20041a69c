"""Steps that follow a list over time, and are skipped just in the frames where it is empty."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from tactile_graph.pipeline.graph import Graph, Node
from tactile_graph.pipeline.wiring import Ref

NOTHING: dict[str, int] = {"count": 0, "loaded": False}
"""Fields by which values tell conditions that nothing is there, and what they then hold."""


def unseen_ends(pipeline: Graph, asked: Sequence[str] = ()) -> list[str]:
    """Return what is to be said of steps that never see that their list has become empty.

    A step that takes a list and the time since it last ran keeps its state while it is skipped:
    what leaves in the frames between is not told, and what comes after them may pass for it.

    Parameters
    ----------
    pipeline : Graph
    asked : sequence of str, optional
        What is asked of it; its outputs if nothing is.
    """
    refs = [pipeline.outputs.get(name) or pipeline.ref(name) for name in asked]
    needed = pipeline.needed(refs or pipeline.outputs.values())
    told = []
    for node in (pipeline.nodes[name] for name in pipeline.nodes if name in needed):
        guarded = next(_skipped_where_empty(pipeline, node), None)
        if guarded is not None and guarded.guard is not None:
            of = "" if guarded is node else f" of node {guarded.name!r}"
            told.append(
                f"node {node.name!r}: never sees its list empty, for 'when: {guarded.guard.text}'"
                f"{of} skips it there; what comes later may pass for what was there before. "
                "Without the condition the two are told apart"
            )
    return told


def _skipped_where_empty(pipeline: Graph, node: Node) -> Iterator[Node]:
    """Yield the nodes whose conditions keep a step that follows a list from the empty ones."""
    if node.signature is None or not node.signature.gap:
        return
    lists = [r for b in node.inputs if b.port.required and b.port.item is not None for r in b.refs]
    made_of = pipeline.needed(lists)
    for before in (node, *_before(pipeline, lists)):
        empty = {
            ref: NOTHING[ref.path[-1]]
            for ref in (before.guard.refs if before.guard else ())
            if ref.path and ref.path[-1] in NOTHING and not ref.item_path and ref.node in made_of
        }
        if before.guard and before.guard.settled(empty) is False:
            yield before


def _before(pipeline: Graph, refs: Iterable[Ref]) -> Iterator[Node]:
    """Yield the nodes without which there are no values of these references."""
    waiting, seen = [r.node for r in refs], set[str]()
    while waiting:
        name = waiting.pop()
        if name in seen or name not in pipeline.nodes:
            continue
        seen.add(name)
        node = pipeline.nodes[name]
        yield node
        waiting += [b.refs[0].node for b in node.inputs if b.port.required and not b.collects]
        waiting += [c.node for c in node.choices if len(node.choices) == 1]
