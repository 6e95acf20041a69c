"""Settings that a file marks free: the values they may take where a search chooses them."""

from __future__ import annotations

from typing import Any

from tactile_graph.errors import PipelineError, TactileGraphError, did_you_mean, one_of
from tactile_graph.pipeline.declaration import NodeDeclaration
from tactile_graph.pipeline.resolution.scope import Scope
from tactile_graph.steps.settings import validate_settings
from tactile_graph.steps.signature import Signature


def free_of_step(scope: Scope, declared: NodeDeclaration, signature: Signature) -> None:
    """Enter a step's free settings; each value has to be one that the step takes."""
    known = [s.name for s in signature.settings]
    for name, values in declared.free.items():
        if name not in known:
            hint = did_you_mean(name, known) or f"; {signature.name} takes: {one_of(known)}"
            scope.problem(declared, f": unknown setting {name!r}{hint}", "free", name, key=True)
            continue
        for i, value in enumerate(values):
            _, troubles = validate_settings(signature, {name: value})
            for path, message in troubles:
                if path[:1] == (name,):
                    scope.problem(declared, f", {name}: {message}", "free", name, i)
        scope.free[f"{declared.name}.{name}"] = tuple(values)


def free_of_use(scope: Scope, declared: NodeDeclaration) -> None:
    """Enter the free settings of an embedded pipeline's nodes, ``node.setting`` in the file."""
    for name, values in declared.free.items():
        node, _, setting = name.rpartition(".")
        if not node:
            text = f", {name}: settings of an embedded pipeline are named node.setting"
            scope.problem(declared, text, "free", name, key=True)
            continue
        for i, value in enumerate(values):
            for message in _refused(scope, declared, node, setting, value):
                scope.problem(declared, f", {name}: {message}", "free", name, i)
        scope.free[f"{declared.name}/{name}"] = tuple(values)


def _refused(
    scope: Scope, declared: NodeDeclaration, node: str, setting: str, value: Any
) -> list[str]:
    """Return what the embedded pipeline says against a value, next to what is said anyway."""
    try:
        scope.load(str(declared.use), {node: {setting: value}})
    except TactileGraphError as error:
        problems = error.problems if isinstance(error, PipelineError) else (error,)
        mine = f"setting {node}.{setting}: "
        return [str(p).removeprefix(mine) for p in problems]
    return []
