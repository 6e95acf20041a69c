"""Describe the merged graph: its nodes, whose they are, what they did and cost."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from tactile_graph.inspect import Node, plain
from tactile_graph_compare.records.graph import MergedEdge, MergedGraph, MergedNode
from tactile_graph_compare.run.session import Session


def merged_graph(session: Session) -> MergedGraph:
    """Return the graph of a session, with what each node came to over the frames so far."""
    pipeline = session.merged.pipeline
    log = session.merged_log
    names, states, times = log.nodes, log.states(), log.times_us()
    owners = _owners(session)
    nodes = tuple(
        _node(session, pipeline.nodes[name], owners[name], states[:, i], times[:, i])
        for i, name in enumerate(names)
    )
    edges = tuple(e for name in names for e in _edges(pipeline.nodes[name]))
    return MergedGraph(nodes, edges, pipeline)


def _owners(session: Session) -> dict[str, dict[str, tuple[str, ...]]]:
    """Return for each merged node the variants that have it, and their names for it."""
    found: dict[str, dict[str, tuple[str, ...]]] = {n: {} for n in session.merged_log.nodes}
    for log in session.logs:
        for own in log.nodes:
            owners = found[log.member.names[own]]
            label = log.prepared.label
            owners[label] = (*owners.get(label, ()), own)
    return found


def _node(
    session: Session,
    node: Node,
    owners: dict[str, tuple[str, ...]],
    states: NDArray[np.uint8],
    times_us: NDArray[np.float64],
) -> MergedNode:
    ran = times_us[times_us > 0.0]
    return MergedNode(
        name=node.name,
        own_name=next(iter(owners.values()))[0],
        kind=node.kind.value,
        what=node.what,
        settings=plain(node.settings),
        guard=node.guard.text if node.guard is not None else "",
        own_names=owners,
        new_in=tuple(_new_in(session, owners)),
        output_of=tuple(
            log.prepared.label
            for log in session.logs
            if node.name in {log.member.ref(r).node for r in log.member.asked}
        ),
        stateful=node.stateful,
        n_ran=int((states == 1).sum()),
        n_skipped=int((states == 2).sum()),
        n_failed=int((states == 3).sum()),
        n_not_asked=int((states == 0).sum()),
        time_us=float(np.median(ran)) if ran.size else 0.0,
        total_s=float(np.nansum(times_us)) * 1e-6,
    )


def _new_in(session: Session, owners: dict[str, tuple[str, ...]]) -> Iterator[str]:
    """Yield the variants that have the node while the parent they evolved from has not."""
    for log in session.logs:
        label, parent = log.prepared.label, log.prepared.parent
        if label in owners and parent and parent not in owners:
            yield label


def _edges(node: Node) -> Iterator[MergedEdge]:
    for ref in node.guard.refs if node.guard is not None else ():
        yield MergedEdge(ref.node, node.name, "guard", "when", ".".join(ref.path))
    for binding in node.inputs:
        for ref in binding.refs:
            path = ".".join((*ref.path, *ref.item_path))
            yield MergedEdge(ref.node, node.name, "data", binding.port.name, path)
    for ref in node.choices:
        yield MergedEdge(ref.node, node.name, "choice", "", ".".join(ref.path))
