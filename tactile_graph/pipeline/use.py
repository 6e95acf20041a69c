"""Resolve a node that uses another pipeline: inlined, or run for each item of a list."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from tactile_graph.errors import PipelineError, TactileGraphError
from tactile_graph.pipeline.conditions import Guard
from tactile_graph.pipeline.declaration import NodeDeclaration
from tactile_graph.pipeline.embed import Embedding, inline_nodes, map_node
from tactile_graph.pipeline.facts import embedded_rules, limited, ref_facts, where_reached
from tactile_graph.pipeline.graph import FRAME, Graph, node_key
from tactile_graph.pipeline.scope import Scope
from tactile_graph.pipeline.wiring import Ref


def resolve_use(scope: Scope, declared: NodeDeclaration, guard: Guard | None) -> None:
    """Enter what a ``use`` stands for; what is wrong with it is reported in the scope."""
    inner = _inner(scope, declared)
    found = None if inner is None else _input(scope, declared)
    if inner is None or found is None:
        scope.add_unknown(declared.name)
        return
    ref, kind = found
    facts = limited(ref_facts(ref, scope.facts), where_reached(scope.facts, guard))
    at = Embedding(declared.name, scope.mark(declared), ref, kind, facts, guard)
    if declared.each:
        _map(scope, declared, inner, at)
    else:
        _inline(scope, declared, inner, at)


def _inner(scope: Scope, declared: NodeDeclaration) -> Graph | None:
    overrides: dict[str, dict[str, Any]] = {}
    for name, value in declared.settings.items():
        node, dot, setting = name.rpartition(".")
        if not dot:
            text = f", {name}: settings of an embedded pipeline are named node.setting"
            scope.problem(declared, text, "with", name)
            continue
        overrides.setdefault(node, {})[setting] = value
    prefix = f"{declared.name}/"
    for name, values in scope.overrides.items():
        if name.startswith(prefix):
            overrides.setdefault(name[len(prefix) :], {}).update(values)
    try:
        return scope.load(str(declared.use), overrides)
    except TactileGraphError as error:
        problems = error.problems if isinstance(error, PipelineError) else (error,)
        for problem in problems:
            _cannot_be_used(scope, declared, str(problem))
        return None


def _cannot_be_used(scope: Scope, declared: NodeDeclaration, text: str) -> None:
    """Report what is wrong with an embedded pipeline, of a setting given here at the setting."""
    for name in declared.settings:
        mine = f"setting {name}: "
        if text.startswith(mine):
            scope.problem(declared, f", {name}: {text.removeprefix(mine)}", "with", name)
            return
    scope.problem(declared, f": pipeline {declared.use!r} cannot be used: {text}", "use")


def _input(scope: Scope, declared: NodeDeclaration) -> tuple[Ref, Any] | None:
    wired = declared.inputs
    if isinstance(wired, dict) and list(wired) == [FRAME]:
        wired = wired[FRAME]
    if wired is None:
        wired = FRAME
    if not isinstance(wired, str):
        scope.problem(declared, ": an embedded pipeline has one port, 'frame'", "in")
        return None
    return scope.ref(declared, wired, "in")


def _map(scope: Scope, declared: NodeDeclaration, inner: Graph, at: Embedding) -> None:
    node, trouble = map_node(inner, at)
    if trouble:
        scope.problem(declared, f": {trouble}", "in")
    key = node_key("map", inner.key, scope.ref_key(at.ref), scope.guard_key(at.guard))
    scope.add(replace(node, key=key))


def _inline(scope: Scope, declared: NodeDeclaration, inner: Graph, at: Embedding) -> None:
    nodes, troubles = inline_nodes(inner, at)
    broken, rules = embedded_rules(at.name, inner.frame_rules, at.facts, scope.frames)
    scope.rules += rules
    for trouble in [*troubles, *broken]:
        scope.problem(declared, f": {trouble}", "in")
    for node in nodes:
        key = node_key("in", node.key, scope.ref_key(at.ref), scope.guard_key(node.guard))
        scope.add(replace(node, key=key))
