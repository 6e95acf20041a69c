"""Which steps run in processes of their own: by the node, by the file's list, by their plugin.

What a node says of itself counts first. Then comes the list ``isolated`` of the file, which names
steps, or all those of a plugin as ``plugin.*``; it holds for pipelines that are used as well. Last
comes what the plugin says of its own steps, by the hook ``tactile_graph_isolated``. Steps that come
under one name of the list, or are marked by one plugin, share a process.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from tactile_graph.errors import UsageError, did_you_mean
from tactile_graph.pipeline.declaration import NodeDeclaration
from tactile_graph.pipeline.graph import Graph, Isolation, Node, NodeKind
from tactile_graph.pipeline.resolution.scope import Scope
from tactile_graph.plugins.names import Offer
from tactile_graph.steps.signature import Signature

ALL = ".*"
"""Behind a plugin's name: all of its steps."""


def check_isolated(scope: Scope) -> None:
    """Report names in the file's list that neither a step nor a plugin has."""
    registry, known = scope.registry, [p.name + ALL for p in scope.registry.plugins]
    for i, name in enumerate(scope.declaration.isolated):
        if name.endswith(ALL):
            if name not in known:
                hint = did_you_mean(name, known)
                text = f"'isolated': no plugin named {name.removesuffix(ALL)!r}{hint}"
                scope.document.problem(text, "isolated", i)
            continue
        try:
            registry.offer("steps", name, scope.place)
        except UsageError as error:
            text = f"'isolated': {error}; all steps of a plugin are named plugin{ALL}"
            scope.document.problem(text, "isolated", i)


def isolation_of(scope: Scope, declared: NodeDeclaration, signature: Signature) -> Isolation | None:
    """Return in what process a node's step runs; None for that of the others."""
    if declared.isolated or declared.time_limit_s is not None:
        return Isolation(declared.time_limit_s)
    if declared.isolated is False:
        return None
    offer = scope.registry.offer("steps", signature.name, scope.place)
    listed = _listed(scope, offer)
    if listed is not None:
        return listed
    limits: Mapping[str, float | None] = offer.plugin.offers.get("isolated", {})
    return Isolation(limits[offer.name], offer.plugin.name) if offer.name in limits else None


def isolated_within(scope: Scope, node: Node) -> Node:
    """Return a node of a pipeline that is used, as the list of the file that uses it has it."""
    if not scope.declaration.isolated:
        return node
    if node.inner is not None:
        nodes = {name: isolated_within(scope, inner) for name, inner in node.inner.nodes.items()}
        inner: Graph = replace(node.inner, nodes=nodes)
        return replace(node, inner=inner)
    if node.kind is not NodeKind.STEP or node.signature is None or node.isolation is not None:
        return node
    offer = scope.registry.offer("steps", node.signature.name, scope.place)
    return replace(node, isolation=_listed(scope, offer))


def _listed(scope: Scope, offer: Offer) -> Isolation | None:
    for name in scope.declaration.isolated:
        if name == offer.plugin.name + ALL:
            return Isolation(process=offer.plugin.name)
        if name.endswith(ALL) or not scope.registry.has("steps", name):
            continue
        if scope.registry.offer("steps", name, scope.place) is offer:
            return Isolation(process=offer.qualified)
    return None
