"""Registries that hold the project's own plugins and one under test, whatever else is installed."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib.metadata import entry_points
from types import ModuleType
from typing import Any

from tactile_graph.plugins.hookspecs import hookimpl
from tactile_graph.plugins.registry import GROUP, Registry

OWN = "tactile-graph"


def isolated(
    steps: Mapping[str, str | Callable[..., Any]] | None = None, plugin: ModuleType | None = None
) -> Registry:
    """Return a registry of the project's own plugins, and of what is under test.

    Parameters
    ----------
    steps : mapping of str to callable or str, optional
        Steps by name, themselves or by import string.
    plugin : module, optional
        What the entry point of a plugin names: the module with its hooks.
    """
    found = entry_points(group=GROUP)
    own = [
        (e.name, OWN, e.dist.version, e.load)
        for e in sorted(found, key=lambda e: e.name)
        if e.dist is not None and e.dist.name == OWN
    ]
    made = {} if plugin is None else {plugin.__name__: plugin}
    if steps is not None:
        made["under-test"] = _offering(dict(steps))
    others = [(n, "under test", "0", lambda module=m: module) for n, m in made.items()]
    return Registry([*own, *others])


def _offering(steps: Mapping[str, str | Callable[..., Any]]) -> ModuleType:
    @hookimpl
    def tactile_graph_steps() -> Mapping[str, str | Callable[..., Any]]:
        return steps

    module = ModuleType("steps_under_test")
    module.tactile_graph_steps = tactile_graph_steps  # type: ignore[attr-defined]
    return module
