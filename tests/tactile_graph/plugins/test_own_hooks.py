"""A plugin may have hooks of its own, that others answer; what is offered is what was asked for."""

from __future__ import annotations

import sys
from collections.abc import Callable
from types import ModuleType
from typing import Any, NamedTuple

import pytest

from tactile_graph import hookimpl
from tactile_graph.errors import PluginError
from tactile_graph.plugins.hookspecs import hook_of
from tactile_graph.plugins.registry import Registry, Selection, singular
from tactile_graph.testing.plugin_check import examine_plugin

Loader = Callable[[], ModuleType]


class Lamp(NamedTuple):
    """What the hook asks for."""

    watt: float


RED = Lamp(40.0)
STONE = 3


@hook_of(f"{__name__}:Lamp")
def tactile_graph_lamps() -> Any:
    """Lamp -> import string of its `Lamp`."""


@pytest.fixture(autouse=True)
def _importable(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, __name__, sys.modules[Lamp.__module__])


def owner(hook: Callable[[], Any] = tactile_graph_lamps) -> Loader:
    """Return a plugin that has a hook."""
    module, hookspecs = ModuleType("owner"), ModuleType("hookspecs")
    setattr(hookspecs, hook.__name__, hook)
    module.hookspecs = hookspecs  # type: ignore[attr-defined]
    return lambda: module


def answering(kind: str = "lamps", **answer: Any) -> Loader:
    """Return a plugin that answers it."""
    module = ModuleType("answering")
    setattr(module, f"tactile_graph_{kind}", hookimpl(lambda: answer))
    return lambda: module


def registry(*plugins: tuple[str, Loader], select: str = "") -> Registry:
    rows = [(name, f"{name}-package", "1", loader) for name, loader in plugins]
    return Registry(rows, Selection.parse(select))


def test_whoever_comes_first_answers_a_hook_of_another() -> None:
    found = registry(("a", answering(red=f"{__name__}:RED")), ("owner", owner()))
    assert [p.error for p in found.plugins] == ["", ""]
    assert found.names("lamps") == ["red"]
    assert found.load("lamps", "red") is RED
    assert found.kinds[-1] == "lamps"


def test_what_is_not_of_the_hooks_type_is_told_by_plugin_and_by_the_check() -> None:
    found = registry(("owner", owner()), ("a", answering(odd=f"{__name__}:STONE")))
    told = r"lamp 'odd' of plugin 'a' \(package a-package\) must be a \S*Lamp, got 3"
    with pytest.raises(PluginError, match=told):
        found.load("lamps", "odd")
    again = registry(("owner", owner()), ("a", answering(odd=f"{__name__}:STONE")))
    (line,) = examine_plugin(again.plugins[1], again).broken
    assert f"must be a {__name__}.Lamp, got 3" in line


def test_a_plugin_whose_hooks_owner_is_blocked_or_broken_loads_all_the_same() -> None:
    def broken() -> ModuleType:
        raise ImportError("no")

    for loader, select in ((owner(), "-owner"), (broken, "")):
        found = registry(("owner", loader), ("a", answering(red="x:y")), select=select)
        assert found.plugins[1].error == ""
        assert found.names("lamps") == []
        assert not found.has("lamps", "red")


def test_a_hook_that_nobody_has_is_misspelt() -> None:
    found = registry(("owner", owner()), ("a", answering("lmaps", red="x:y")))
    assert "unknown hook 'tactile_graph_lmaps'; did you mean 'tactile_graph_lamps'?" in (
        found.plugins[1].error
    )


def test_a_hook_of_a_name_that_is_taken_is_refused() -> None:
    def tactile_graph_steps() -> Any: ...

    taken = hook_of("x:Y")(tactile_graph_steps)
    found = registry(("owner", owner(taken)))
    assert "there is a hook tactile_graph_steps already" in found.plugins[0].error


def test_a_taken_quantity_is_told_and_a_unit_that_is_no_text_told() -> None:
    found = registry(
        ("a", answering("quantities", newton="N")), ("b", answering("quantities", newton="kp"))
    )
    assert found.clashes == [
        "quantity 'newton' of plugin 'b' (package b-package) is called b.newton: "
        "plugin 'a' (package a-package) has the plain name"
    ]
    assert found.offer("quantities", "newton").target == "N"
    (bad,) = registry(("a", answering("quantities", newton=3))).plugins
    assert "'newton' is 3, its unit is needed" in bad.error


@pytest.mark.parametrize("name", ["md", ".MD"])
def test_a_name_that_is_no_ending_is_refused_where_one_is_needed(name: str) -> None:
    (bad,) = registry(("a", answering("exporters", **{name: "x:y"}))).plugins
    assert f"such as '.csv', got '{name}'" in bad.error


@pytest.mark.parametrize(
    ("kind", "one"),
    [("steps", "step"), ("file_kinds", "file kind"), ("quantities", "quantity")],
)
def test_one_of_a_kind_is_named(kind: str, one: str) -> None:
    assert singular(kind) == one
