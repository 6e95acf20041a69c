"""What is checked once all nodes are known: every condition, and every setting from outside."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tactile_graph.errors import Mark, Problem, did_you_mean, one_of
from tactile_graph.pipeline.conditions.conditions import compile_condition, without_comments
from tactile_graph.pipeline.document import Path, on_one_line
from tactile_graph.pipeline.plain import plain
from tactile_graph.pipeline.references import ConditionError
from tactile_graph.pipeline.resolution.facts import ref_facts
from tactile_graph.pipeline.resolution.scope import Scope
from tactile_graph.pipeline.wiring import Ref


def check_conditions(scope: Scope) -> None:
    """Report conditions that are wrong, used or not; a named one only where it stands."""
    named = scope.declaration.conditions
    _check_comments(scope)
    errors: dict[str, ConditionError] = {}
    for name, text in named.items():
        try:
            compile_condition(text, scope.types, named, scope.declaration.nodes)
        except ConditionError as error:
            errors[name] = error
    broken = {n for n, e in errors.items() if e.named in ("", n)}
    for name, wrong in errors.items():
        if name in broken or wrong.named not in broken:
            what = f"condition {name!r}: {wrong.message}"
            _condition_problem(scope, what, named[name], wrong, "conditions", name)
    for node, wrong in scope.condition_errors:
        if wrong.named not in broken:
            what = f"node {node.name!r}, 'when': {wrong.message}"
            _condition_problem(scope, what, node.when or "", wrong, *node.path, "when")


def _check_comments(scope: Scope) -> None:
    """Report comments in conditions whose lines YAML has joined: nobody can tell where they end."""
    declared = scope.declaration
    found: list[tuple[str, str, Path]] = [
        (f"condition {name!r}", text, ("conditions", name))
        for name, text in declared.conditions.items()
    ]
    found += [
        (f"node {node.name!r}, 'when'", node.when or "", (*node.path, "when"))
        for node in declared.nodes.values()
    ]
    for what, text, path in found:
        if scope.document.joins_lines(*path) and without_comments(text) != text:
            words = "a comment in it would swallow the lines below, which YAML joins to its own"
            scope.document.problem(f"{what}: {words}; take it out, or write '|' for '>'", *path)


def check_fields_read(scope: Scope) -> None:
    """Report conditions over fields that images of the quantity at hand do not have.

    A step's output says so of itself: ``field_quantities`` holds the quantities by field.
    """
    for name, node in scope.nodes.items():
        declared = scope.declaration.nodes.get(name)
        for ref in node.guard.refs if node.guard and declared else ():
            wanted = _quantities_of(scope, ref)
            came = _quantities_read(scope, ref.node) if wanted else {}
            here = [came[q] for q in scope.frames if q in came]
            if declared and here and not {"", *wanted}.intersection(here):
                scope.problem(declared, f", 'when': {ref} is there for images in "
                              f"{' or '.join(wanted)}, here they are in {here[0]}: it never runs",
                              "when")  # fmt: skip


def _quantities_of(scope: Scope, ref: Ref) -> tuple[str, ...]:
    """Return the quantities for which a field has a value; nothing where it always may."""
    fields = getattr(scope.types.get(ref.node), "field_quantities", {})
    return tuple(fields.get(ref.path[0], ())) if ref.path else ()


def _quantities_read(scope: Scope, name: str) -> Mapping[str, str]:
    """Return the quantity of the first image a node reads, by the frame's, where it is known."""
    bindings = scope.nodes[name].inputs if name in scope.nodes else ()
    known = (ref_facts(b.refs[0], scope.facts).by_frame for b in bindings if b.refs)
    return next((by_frame for by_frame in known if any(by_frame.values())), {})


def _condition_problem(
    scope: Scope, message: str, text: str, error: ConditionError, *path: str | int
) -> None:
    mark = scope.document.mark(*path)
    column = mark.column + (error.offset if "\n" not in text else 0)
    scope.document.problem_at(Mark(mark.file, mark.line, column), message)


def check_overrides(scope: Scope) -> None:
    """Report settings from outside that no node has."""
    nodes = scope.declaration.nodes
    for name, settings in scope.overrides.items():
        head, slash, _ = name.partition("/")
        if head in nodes and (nodes[head].use if slash else nodes[head].step):
            continue  # checked with the node, or inside the embedded pipeline
        where = f"setting {name}.{next(iter(settings), '')}: "
        if name in nodes:
            inside = f"; inside it they are named {name}/node.setting"
            text = f"node {name!r} is no step and has no settings" + (
                inside if nodes[name].use else "")  # fmt: skip
        elif (parts := name.split("."))[0] in nodes:
            node, setting, *inner = parts
            value: Any = settings
            for part in reversed(inner):
                value = {part: value}
            text = f"a setting is given whole: {node}.{setting}={on_one_line(plain(value))}"
        else:
            known = {*nodes, *(n for n in scope.nodes if "." not in n)}
            hint = did_you_mean(name, known) or f"; there are: {one_of(known)}"
            text = f"no node named {name!r}{hint}"
        scope.document.problems.append(Problem(None, where + text))
