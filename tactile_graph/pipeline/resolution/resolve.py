"""Turn a declaration into a frozen graph: steps, settings, wires, types, rules, guards."""

from __future__ import annotations

import traceback
from collections import Counter
from dataclasses import replace
from typing import Any

from numpy.random import default_rng

from tactile_graph.errors import PluginError, Problem, TactileGraphError, UsageError
from tactile_graph.files import lies_beside
from tactile_graph.pipeline.conditions.conditions import Guard, compile_condition
from tactile_graph.pipeline.declaration import MOST_NODES, NodeDeclaration
from tactile_graph.pipeline.graph import (
    FRAME,
    FrameRule,
    Graph,
    Node,
    NodeKind,
    Source,
    node_key,
)  # fmt: skip
from tactile_graph.pipeline.plain import plain
from tactile_graph.pipeline.references import ConditionError, resolve_reference
from tactile_graph.pipeline.resolution.bind import bind_inputs
from tactile_graph.pipeline.resolution.checks import (
    check_conditions,
    check_fields_read,
    check_overrides,
)
from tactile_graph.pipeline.resolution.facts import (
    choice_facts,
    frame_facts,
    output_facts,
    quantity_troubles,
    source_quantities,
    step_troubles,
)
from tactile_graph.pipeline.resolution.free import free_of_step
from tactile_graph.pipeline.resolution.isolation import check_isolated, isolation_of
from tactile_graph.pipeline.resolution.order import resolvable_order
from tactile_graph.pipeline.resolution.scope import Scope
from tactile_graph.pipeline.resolution.use import resolve_use
from tactile_graph.pipeline.wiring import UNKNOWN, Ref, common_type
from tactile_graph.plugins.mistakes import why
from tactile_graph.shared_process import righted
from tactile_graph.steps.settings import Trouble, spelled, validate_settings
from tactile_graph.steps.signature import Kind, Signature

SourceOverride = tuple[str, dict[str, Any]] | None
"""The step, and its settings, that replace the file's source."""


def resolve(scope: Scope, replaced: SourceOverride = None, embedded: bool = False) -> Graph:
    """Return the graph of a declaration; it is only fit to run if its document has no problems.

    Parameters
    ----------
    scope : Scope
        Empty as yet.
    replaced : tuple of (step name, settings), optional
        Replaces the file's source.
    embedded : bool
        Whether another pipeline uses it: its frames are then not those of its own source.
    """
    source = _source(scope, replaced)
    scope.facts[FRAME] = frame_facts()
    scope.frames = source_quantities(None if embedded else source)
    order, cycles = resolvable_order(scope.declaration)
    for loop in cycles:
        text = f"the nodes form a cycle: {' -> '.join(loop)}"
        scope.document.problem(text, "nodes", loop[0], key=True)
        scope.types.update(dict.fromkeys(loop, UNKNOWN))
    uses = Counter(declared.use for declared in scope.declaration.nodes.values())
    for name in order:
        declared, n_before = scope.declaration.nodes[name], len(scope.nodes)
        try:
            _node(scope, declared)
        except TactileGraphError as error:
            scope.problem(declared, str(error))
            scope.types.setdefault(name, UNKNOWN)
        uses[declared.use] -= 1
        to_come = uses[declared.use] * (len(scope.nodes) - n_before) if declared.use else 0
        _refuse_too_many(scope, declared, len(scope.nodes) + to_come)
    check_isolated(scope)
    check_conditions(scope)
    check_fields_read(scope)
    check_overrides(scope)
    outputs = _outputs(scope)
    d = scope.declaration
    return Graph(
        name=d.name, about=d.about, evolves=d.evolves, source=source,
        nodes=scope.nodes, outputs=outputs, file=scope.document.file,
        text=scope.document.text, frame_rules=tuple(scope.rules), free=scope.free,
        overrides=scope.overrides, source_override=replaced, registry=scope.registry,
        deadline_us=d.deadline_us, files=scope.files,
    )  # fmt: skip


def _refuse_too_many(scope: Scope, declared: NodeDeclaration, n_nodes: int) -> None:
    """Refuse a pipeline by the nodes it has or, with all uses like this one, comes to have."""
    if n_nodes > MOST_NODES:
        raise UsageError(
            f"pipeline {scope.declaration.name!r}, node {declared.name!r}: comes to {n_nodes} "
            f"nodes with those of the pipelines it uses; allowed are {MOST_NODES}"
        )


def _source(scope: Scope, replaced: SourceOverride) -> Source | None:
    d = scope.declaration
    step, given = d.source_step, d.source_settings
    mark = scope.document.mark("source", "step")
    if replaced is not None:
        step, given = replaced
    if step is None:
        return None

    def tell(message: str, *path: str | int) -> None:
        if replaced is None:
            scope.document.problem(message, *path)
        else:  # the file says nothing of it
            scope.document.problem_at(None, message)

    try:
        signature = scope.registry.step(step, scope.place)
    except (UsageError, PluginError) as error:
        tell(f"source: {error}", "source", "step")
        return None
    if signature.kind is not Kind.SOURCE:
        tell(f"source: step {step!r} is no source: it yields no frames", "source", "step")
        return None
    values, troubles = validate_settings(signature, given)
    for path, message in troubles:
        where = f"{spelled(path)}: " if path else ""
        tell(f"source, {where}{message}", "source", "with", *path)
    return Source(signature, values, mark)


def _node(scope: Scope, declared: NodeDeclaration) -> None:
    guard = _guard(scope, declared)
    if declared.first_of is not None:
        _first_of(scope, declared, guard)
    elif declared.use:
        resolve_use(scope, declared, guard)
    elif declared.step:
        _step(scope, declared, guard)
    else:
        scope.add_unknown(declared.name)


def _guard(scope: Scope, declared: NodeDeclaration) -> Guard | None:
    if not declared.when:
        return None
    try:
        d = scope.declaration
        return compile_condition(declared.when, scope.types, d.conditions, d.nodes)
    except ConditionError as error:
        scope.condition_errors.append((declared, error))
        return None


def _first_of(scope: Scope, declared: NodeDeclaration, guard: Guard | None) -> None:
    found = [scope.ref(declared, t, "first_of", i) for i, t in enumerate(declared.first_of or [])]
    choices = tuple(f[0] for f in found if f)
    kind = common_type([f[1] for f in found if f]) if choices else UNKNOWN
    key = node_key("first_of", [scope.ref_key(c) for c in choices], scope.guard_key(guard))
    scope.add(
        Node(declared.name, NodeKind.FIRST_OF, kind, scope.mark(declared), choices=choices,
             guard=guard, facts=choice_facts(choices, scope.facts, guard), key=key)
    )  # fmt: skip


def _settings(scope: Scope, declared: NodeDeclaration, signature: Signature) -> dict[str, Any]:
    values, troubles = validate_settings(signature, scope.given(declared))
    _report(scope, declared, troubles)
    return values


def _report(scope: Scope, declared: NodeDeclaration, troubles: list[Trouble]) -> None:
    outside = scope.overrides.get(declared.name, {})
    for path, message in troubles:
        where = f", {spelled(path)}: " if path else ": "
        if path and path[0] in outside:
            text = f"setting {declared.name}.{spelled(path)}: {message}"
            found = Problem(None, text)
            if found not in scope.document.problems:
                scope.document.problems.append(found)
        else:
            scope.problem(declared, where + message, "with", *path)


def _step(scope: Scope, declared: NodeDeclaration, guard: Guard | None) -> None:
    assert declared.step is not None
    try:
        signature = scope.registry.step(declared.step, scope.place)
    except (UsageError, PluginError) as error:
        scope.problem(declared, f": {error}", "step")
        scope.add_unknown(declared.name)
        return
    if signature.kind is Kind.SOURCE:
        scope.problem(
            declared, f": {declared.step!r} is a source; it belongs under 'source'", "step"
        )
    before = len(scope.document.problems)
    settings = _settings(scope, declared, signature)
    free_of_step(scope, declared, signature)
    inputs = bind_inputs(scope, declared, signature)
    output: Any = signature.output
    if declared.each:
        output = list[output]
        if signature.stateful:
            text = f": a stateful step ({declared.step}) cannot run for each item"
            scope.problem(declared, text, "each")
    key = node_key(
        signature.identity, sorted(plain(settings).items()), declared.each,
        [(b.port.name, [scope.ref_key(r) for r in b.refs]) for b in inputs],
        scope.guard_key(guard),
    )  # fmt: skip
    node = Node(
        declared.name, NodeKind.STEP, output, scope.mark(declared), signature, settings, inputs,
        guard=guard, each=declared.each, key=key,
        isolation=isolation_of(scope, declared, signature),
        facts=output_facts(signature, settings, inputs, scope.facts, guard),
    )  # fmt: skip
    given = scope.given(declared)
    _rules(scope, declared, *step_troubles(node, given, scope.facts, scope.frames))
    whole = len(scope.document.problems) == before and not scope.document.has_unread(*declared.path)
    if whole and signature.kind is Kind.CLASS:
        node = _made(scope, declared, node)
    scope.add(node)


def _made(scope: Scope, declared: NodeDeclaration, node: Node) -> Node:
    """Build a class step once, so that settings it refuses are an error of the file."""
    try:
        rng = node.signature.rng if node.signature and node.signature.rng_at_init else ""
        with righted():
            made = replace(node, callable=node.bound(**{rng: default_rng(0)} if rng else {}))
    except Exception as error:  # a constructor may raise anything about its settings
        told = str(error) if isinstance(error, TactileGraphError) else _on_purpose(error, node)
        text = told or f"step {declared.step!r} cannot be made: {why(error)}"
        hint = lies_beside(scope.document.file, declared.settings, str(text))
        scope.problem(declared, f": {text}{hint}", "with")
        return node
    _rules(scope, declared, *quantity_troubles(made, scope.facts, scope.frames))
    return made


def _on_purpose(error: Exception, node: Node) -> str:
    """Return the words of a ValueError that a step's own package raised; "" for other errors."""
    assert node.signature is not None
    *_, (last, _) = traceback.walk_tb(error.__traceback__)
    package = str(last.f_globals.get("__name__", "")).partition(".")[0]
    ours = package in ("tactile_graph", node.signature.target.__module__.partition(".")[0])
    return " ".join(str(error).split()) if ours and isinstance(error, ValueError) else ""


def _rules(
    scope: Scope,
    declared: NodeDeclaration,
    troubles: list[tuple[str, str]],
    rules: list[FrameRule],
) -> None:
    """Report the rules a node breaks, by port, and keep those that only a frame can settle."""
    scope.rules += rules
    for port, message in troubles:
        path = ("in", port) if isinstance(declared.inputs, dict) else ("in",)
        scope.problem(declared, f": {message}", *path)


def _outputs(scope: Scope) -> dict[str, Ref]:
    outputs: dict[str, Ref] = {}
    for i, text in enumerate(scope.declaration.outputs):
        try:
            ref, _ = resolve_reference(tuple(text.split(".")), scope.types, [])
        except ConditionError as error:
            scope.document.problem(f"output {text!r}: {error.message}", "outputs", i)
            continue
        outputs[text] = ref
    if not outputs and not scope.document.problems:
        scope.document.problem("'outputs' is empty: nothing is asked for", "outputs")
    return outputs
