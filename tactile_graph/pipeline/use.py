"""Resolve a node that uses another pipeline: inlined, or run for each item of a list."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from tactile_graph.errors import PipelineError, TactileGraphError
from tactile_graph.pipeline.conditions import Guard
from tactile_graph.pipeline.declaration import NodeDeclaration
from tactile_graph.pipeline.embed import inline_nodes, map_node
from tactile_graph.pipeline.facts import embedded_rules, ref_facts
from tactile_graph.pipeline.node import FRAME, node_key
from tactile_graph.pipeline.pipeline import Pipeline
from tactile_graph.pipeline.references import resolve_reference
from tactile_graph.pipeline.wiring import UNKNOWN, Ref

if TYPE_CHECKING:
    from tactile_graph.pipeline.resolve import Resolver


def resolve_use(resolver: Resolver, declared: NodeDeclaration, guard: Guard | None) -> None:
    """Enter what a ``use`` stands for; what is wrong with it is reported on the resolver."""
    inner = _inner(resolver, declared)
    ref = None if inner is None else _input(resolver, declared)
    if inner is None or ref is None:
        resolver.scope.types[declared.name] = UNKNOWN
    elif declared.each:
        _map(resolver, declared, inner, ref, guard)
    else:
        _inline(resolver, declared, inner, ref, guard)


def _inner(resolver: Resolver, declared: NodeDeclaration) -> Pipeline | None:
    overrides: dict[str, dict[str, Any]] = {}
    for name, value in declared.settings.items():
        node, dot, setting = name.rpartition(".")
        if not dot:
            text = f", {name}: settings of an embedded pipeline are named node.setting"
            resolver.problem(declared, text, "with", name)
            continue
        overrides.setdefault(node, {})[setting] = value
    prefix = f"{declared.name}/"
    for name, values in resolver.overrides.items():
        if name.startswith(prefix):
            overrides.setdefault(name[len(prefix) :], {}).update(values)
    try:
        return resolver.load(str(declared.use), overrides)
    except TactileGraphError as error:
        problems = error.problems if isinstance(error, PipelineError) else (error,)
        for problem in problems:
            _cannot_be_used(resolver, declared, str(problem))
        return None


def _cannot_be_used(resolver: Resolver, declared: NodeDeclaration, text: str) -> None:
    """Report what is wrong with an embedded pipeline, of a setting given here at the setting."""
    for name in declared.settings:
        mine = f"setting {name}: "
        if text.startswith(mine):
            resolver.problem(declared, f", {name}: {text.removeprefix(mine)}", "with", name)
            return
    resolver.problem(declared, f": pipeline {declared.use!r} cannot be used: {text}", "use")


def _input(resolver: Resolver, declared: NodeDeclaration) -> Ref | None:
    wired = declared.inputs
    if isinstance(wired, dict) and list(wired) == [FRAME]:
        wired = wired[FRAME]
    if wired is None:
        wired = FRAME
    if not isinstance(wired, str):
        resolver.problem(declared, ": an embedded pipeline has one port, 'frame'", "in")
        return None
    found = resolver.ref(declared, wired, "in")
    return None if found is None else found[0]


def _map(
    resolver: Resolver, declared: NodeDeclaration, inner: Pipeline, ref: Ref, guard: Guard | None
) -> None:
    kind = resolve_reference((ref.node, *ref.path), resolver.scope.types, [])[1]
    node, trouble = map_node(declared.name, inner, ref, kind, guard, resolver.mark(declared))
    if trouble:
        resolver.problem(declared, f": {trouble}", "in")
    key = node_key("map", inner.key, resolver.ref_key(ref), resolver.guard_key(guard))
    resolver.scope.add(replace(node, key=key))


def _inline(
    resolver: Resolver, declared: NodeDeclaration, inner: Pipeline, ref: Ref, guard: Guard | None
) -> None:
    kind = resolve_reference((ref.node, *ref.path), resolver.scope.types, [])[1]
    outer = ref_facts(ref, resolver.scope.facts)
    mark = resolver.mark(declared)
    nodes, troubles = inline_nodes(declared.name, inner, ref, kind, guard, mark, outer)
    broken, rules = embedded_rules(declared.name, inner.frame_rules, outer)
    resolver.scope.rules += rules
    for trouble in [*troubles, *broken]:
        resolver.problem(declared, f": {trouble}", "in")
    for node in nodes:
        key = node_key("in", node.key, resolver.ref_key(ref), resolver.guard_key(node.guard))
        resolver.scope.add(replace(node, key=key))
