"""Resolve a node that uses another pipeline: inlined, or run for each item of a list."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from tactile_graph.errors import PipelineError, Problem, TactileGraphError, did_you_mean, one_of
from tactile_graph.pipeline.conditions.conditions import Guard
from tactile_graph.pipeline.declaration import NodeDeclaration
from tactile_graph.pipeline.graph import FRAME, Graph, node_key
from tactile_graph.pipeline.resolution.embed import (
    Embedding,
    Given,
    field_of,
    given_troubles,
    inline_nodes,
    map_node,
    replaced_nodes,
)
from tactile_graph.pipeline.resolution.facts import (
    embedded_rules,
    limited,
    ref_facts,
    where_reached,
)
from tactile_graph.pipeline.resolution.free import free_of_use
from tactile_graph.pipeline.resolution.isolation import isolated_within
from tactile_graph.pipeline.resolution.scope import Scope


def resolve_use(scope: Scope, declared: NodeDeclaration, guard: Guard | None) -> None:
    """Enter what a ``use`` stands for; what is wrong with it is reported in the scope."""
    inner = _inner(scope, declared)
    wired = None if inner is None else _inputs(scope, declared, inner)
    if inner is None or wired is None or not _parts_outputs(scope, declared, inner):
        scope.add_unknown(declared.name)
        return
    frame = wired.pop(FRAME)
    facts = limited(frame.facts, where_reached(scope.facts, guard))
    frame = replace(frame, facts=facts)
    at = Embedding(declared.name, scope.mark(declared), frame, guard, wired)
    _check_given(scope, declared, inner, at)
    free_of_use(scope, declared)
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


def _parts_outputs(scope: Scope, declared: NodeDeclaration, inner: Graph) -> bool:
    """Return whether no two outputs have one name here, where dots are ``_``; else report them."""
    found: dict[str, str] = {}
    for output in inner.outputs:
        other = found.setdefault(field_of(output), output)
        if other != output:
            what = f"outputs {other!r} and {output!r} of pipeline {declared.use!r}"
            text = f": {what} would both be {declared.name}.{field_of(output)} here; rename a node"
            scope.problem(declared, text, "use")
            return False
    return True


def _inputs(scope: Scope, declared: NodeDeclaration, inner: Graph) -> dict[str, Given] | None:
    """Return what takes the place of the frame, and of which nodes; None where that is wrong."""
    wired = declared.inputs
    if wired is None or isinstance(wired, str):
        wired = {FRAME: wired or FRAME}
    if not isinstance(wired, dict):
        text = (
            ": an embedded pipeline takes one input, its frame, or a map: its frame and any of "
            "its nodes, {frame: …, node: …}"
        )
        scope.problem(declared, text, "in")
        return None
    found: dict[str, Given] = {}
    for name, text in {FRAME: FRAME, **wired}.items():
        path = ("in", name) if isinstance(declared.inputs, dict) else ("in",)
        if name != FRAME and name not in inner.nodes:
            known = [FRAME, *inner.nodes]
            hint = did_you_mean(name, known) or f"; there are: {one_of(known)}"
            what = f": pipeline {declared.use!r} has no node {name!r} to take the place of{hint}"
            scope.problem(declared, what, *path, key=True)
            return None
        if not isinstance(text, str):
            scope.problem(declared, f": {name!r} takes one input, not a list", *path)
            return None
        ref = scope.ref(declared, text, *path)
        if ref is None:
            return None
        found[name] = Given(*ref, ref_facts(ref[0], scope.facts))
    return found


def _check_given(scope: Scope, declared: NodeDeclaration, inner: Graph, at: Embedding) -> None:
    """Report values that cannot stand for nodes, and settings of nodes that do not run."""
    for name, what in given_troubles(inner, at):
        scope.problem(declared, f": {what}", "in", name)
    gone = replaced_nodes(inner, at.given)

    def why_idle(node: str) -> str:
        if node not in gone:
            return ""
        which = "'in' takes its place" if node in at.given else "nothing needs it here"
        return f"{node!r} does not run: {which}"

    for setting in declared.settings:
        if why := why_idle(setting.rpartition(".")[0]):
            scope.problem(declared, f", {setting}: {why}", "with", setting)
    for name, settings in scope.overrides.items():
        head, _, node = name.partition("/")
        if head == declared.name and (why := why_idle(node.partition("/")[0])):
            told = f"setting {name}.{next(iter(settings), '')}: {why}"
            scope.document.problems.append(Problem(None, told))


def _map(scope: Scope, declared: NodeDeclaration, inner: Graph, at: Embedding) -> None:
    node, troubles = map_node(inner, at)
    node = isolated_within(scope, node)
    for trouble in troubles:
        scope.problem(declared, f": {trouble}", "in")
    key = node_key("map", inner.key, *_read_keys(scope, at), scope.guard_key(at.guard))
    scope.add(replace(node, key=key))


def _inline(scope: Scope, declared: NodeDeclaration, inner: Graph, at: Embedding) -> None:
    nodes, troubles = inline_nodes(inner, at)
    gone = replaced_nodes(inner, at.given)
    left = [rule for rule in inner.frame_rules if rule.node not in gone]
    broken, rules = embedded_rules(at.name, left, at.frame.facts, scope.frames)
    scope.rules += rules
    for trouble in [*troubles, *broken]:
        scope.problem(declared, f": {trouble}", "in")
    for node in nodes:
        key = node_key("in", node.key, *_read_keys(scope, at), scope.guard_key(node.guard))
        scope.add(replace(isolated_within(scope, node), key=key))


def _read_keys(scope: Scope, at: Embedding) -> list[object]:
    """Return what makes two embeddings read the same."""
    given = [(name, scope.ref_key(value.ref)) for name, value in at.given.items()]
    return [scope.ref_key(at.frame.ref), *sorted(given)]
