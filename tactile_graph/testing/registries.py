"""Registries that hold the project's own plugins and one under test, whatever else is installed."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import ModuleType
from typing import Any

from tactile_graph.plugins.hookspecs import hookimpl
from tactile_graph.plugins.names import OWN
from tactile_graph.plugins.registry import Registry, found_plugins


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
    own = [row for row in found_plugins() if row[1] == OWN]
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
