"""A plugin can break; the rest goes on, and everything is told by name."""

from __future__ import annotations

import importlib
import re
import sys
import types
from collections.abc import Callable, Iterator
from importlib.metadata import EntryPoint
from pathlib import Path
from typing import Any

import pytest

from tactile_graph import Image, hookimpl
from tactile_graph.errors import PluginError, UsageError
from tactile_graph.plugins import registry as registry_module
from tactile_graph.plugins.mistakes import near_groups
from tactile_graph.plugins.registry import Registry, Selection, installed, restrict


def step(image: Image) -> Image:
    return image


def _returning(answer: Any) -> Callable[[], Any]:
    return lambda: answer


def plugin(**offers: Any) -> Callable[[], types.ModuleType]:
    """Return a loader of a plugin whose hooks return what is given."""
    module = types.ModuleType("plugin")
    for kind, answer in offers.items():
        setattr(module, f"tactile_graph_{kind}", hookimpl(_returning(answer)))
    return lambda: module


def broken(error: BaseException) -> Callable[[], types.ModuleType]:
    def load() -> types.ModuleType:
        raise error

    return load


def offered(*rows: tuple[str, Callable[[], types.ModuleType]], select: str = "") -> Registry:
    return Registry(
        [(name, f"{name}-package", "1.0", loader) for name, loader in rows], Selection.parse(select)
    )


GOOD = ("good", plugin(steps={"step": step}, pipelines={"p": Path("p.yaml")}))


@pytest.mark.parametrize(
    ("error", "message"),
    [
        (ImportError("no module named 'torch'"), "no module named 'torch'"),
        (SyntaxError("bad"), "SyntaxError: bad"),
        (SystemExit(2), "SystemExit: 2"),
        (ZeroDivisionError("x"), "ZeroDivisionError: x"),
    ],
)
def test_a_plugin_that_cannot_be_imported_is_reported_and_the_rest_works(
    error: BaseException, message: str
) -> None:
    found = offered(("bad", broken(error)), GOOD)
    bad, good = found.plugins
    assert (bad.name, bad.package) == ("bad", "bad-package")
    assert re.fullmatch(rf"{re.escape(message)}( \(.*test_registry\.py:\d+\))?", bad.error)
    assert bad.import_ms > 0
    assert bad.label == "plugin 'bad' (package bad-package)"
    assert good.error == ""
    assert found.names("steps") == ["step"]
    assert found.step("step").name == "step"


def test_what_is_missing_is_told_with_the_plugins_that_are_down() -> None:
    found = offered(("bad", broken(ImportError("x"))), GOOD)
    with pytest.raises(
        UsageError,
        match=r"no step named 'stp'; did you mean 'step'\? \(plugins failed to "
        r"load: bad; 'tactile-graph plugins' says why\)",
    ):
        found.step("stp")
    with pytest.raises(UsageError, match="no pipeline named 'zzz'; there are: p"):
        found.path("pipelines", "zzz")


NEITHER = (
    "packages aa-one and zz-two have a plugin of this name each, so none of them has it; "
    "uninstall all but one, or give its entry point another name"
)
OURS = "package tactile-graph has a plugin of this name already; give the entry point another"
LATE = ("late", plugin(steps={"step": "x:y", "more": step}, pads={"pad": Path("late.yaml")}))


def test_a_step_that_two_plugins_offer_is_ambiguous_until_it_is_qualified() -> None:
    found = offered(GOOD, LATE)
    told = (
        "step 'step' is ambiguous: plugin 'good' (package good-package) and "
        "plugin 'late' (package late-package) offer it; write good.step or late.step"
    )
    assert found.clashes == [told]
    with pytest.raises(UsageError, match=f"^{re.escape(told)}$"):
        found.step("step")
    assert found.load("steps", "good.step") is step
    assert found.step("good.step").name == "good.step"
    assert found.offer("steps", "late.step").target == "x:y"
    assert found.names("steps") == ["good.step", "late.step", "more"]


def test_a_name_that_is_not_shared_may_be_qualified_and_stays_plain() -> None:
    found = offered(GOOD, LATE)
    assert found.step("late.more") is found.step("more")
    assert found.step("late.more").name == "more"
    assert found.spelled("steps", "late.more") == "more"


def test_a_file_of_a_package_means_its_own_step_and_pipeline(tmp_path: Path) -> None:
    for name in ("good", "late"):
        (tmp_path / f"{name}.yaml").touch()
    found = offered(
        ("good", plugin(steps={"step": step}, pipelines={"p": tmp_path / "good.yaml"})),
        ("late", plugin(steps={"step": "x:y"}, pipelines={"p": tmp_path / "late.yaml"})),
    )
    for name in ("good", "late"):
        file = str(tmp_path / f"{name}.yaml")
        assert found.offer("steps", "step", file).plugin.name == name
        assert found.path("pipelines", "p", file) == tmp_path / f"{name}.yaml"
    with pytest.raises(UsageError, match=r"write good\.step or late\.step"):
        found.step("step", str(tmp_path / "mine.yaml"))


def test_of_two_pads_the_first_has_the_plain_name_and_the_other_is_had_by_its_own() -> None:
    found = offered(("good", plugin(pads={"pad": Path("good.yaml")})), LATE)
    assert found.path("pads", "pad") == Path("good.yaml")
    assert found.path("pads", "late.pad") == Path("late.yaml")
    assert found.names("pads") == ["late.pad", "pad"]
    assert found.clashes == [
        "pad 'pad' of plugin 'late' (package late-package) is called late.pad: "
        "plugin 'good' (package good-package) has the plain name"
    ]


def test_a_qualified_name_that_is_not_there_is_told_what_is_near() -> None:
    found = offered(GOOD, LATE)
    for given, told in {
        "late.mor": "no step named 'late.mor'; did you mean 'late.more'?",
        "lat.more": "no step named 'lat.more'; did you mean 'late.more'?",
        "late.zzzz": "no step named 'late.zzzz'; there are: late.more, late.step",
        "mor": "no step named 'mor'; did you mean 'more'?",
    }.items():
        with pytest.raises(UsageError, match=f"^{re.escape(told)}$"):
            found.step(given)


def test_two_plugins_of_one_name_do_not_replace_each_other() -> None:
    for packages, steps, errors in (
        (("aa-one", "zz-two"), [], [NEITHER, NEITHER]),
        (("tactile-graph", "aa-one"), ["step"], ["", OURS]),
    ):
        rows = zip(packages, ({"step": step}, {"other": step}), strict=True)
        found = Registry([("good", p, "1.0", plugin(steps=offers)) for p, offers in rows])
        assert [plugin.error for plugin in found.plugins] == errors
        assert found.names("steps") == steps


def test_a_name_of_two_plugins_is_told_with_both_packages() -> None:
    rows = [("same", p, "1.0", plugin(steps={"scaled": step})) for p in ("aa-one", "zz-two")]
    found = Registry(rows)
    told = f"no step named 'same.scaled': plugin 'same' failed to load: {NEITHER}"
    with pytest.raises(UsageError, match=f"^{re.escape(told)}$"):
        found.step("same.scaled")
    assert found.missing_plugins().startswith(" (plugins failed to load: same; ")


@pytest.mark.parametrize(
    ("offers", "message"),
    [
        ({"steps": 3}, "^hook tactile_graph_steps must return a mapping, got 3"),
        ({"steps": ["a"]}, r"must return a mapping, got \['a'\]"),
        ({"steps": None}, "must return a mapping, got None"),
        ({"steps": {1: step}}, "hook tactile_graph_steps: a name must be a text, got 1"),
        ({"steps": {"": step}}, "a name must be a text, got ''"),
        ({"steps": {"a": 3}}, "'a' is 3, an import string \"module:name\" is needed"),
        (
            {"pipelines": {"a": 3}},
            "hook tactile_graph_pipelines: 'a' is 3, a file's path is needed",
        ),
        ({"commands": {"a": step}}, "'a' is <function step.*, an import string"),
    ],
)
def test_a_hook_that_returns_rubbish_is_reported(offers: Any, message: str) -> None:
    found = offered(("bad", plugin(**offers)), GOOD)
    assert re.search(message, found.plugins[0].error)
    assert found.plugins[0].offers == {}
    assert found.names("steps") == ["step"]


def test_a_hook_that_raises_or_is_not_known_is_reported() -> None:
    @hookimpl
    def tactile_graph_steps() -> dict[str, Any]:
        raise RuntimeError("later")

    @hookimpl
    def tactile_graph_stpes() -> dict[str, Any]:
        return {}

    raising, unknown = types.ModuleType("a"), types.ModuleType("b")
    raising.tactile_graph_steps = tactile_graph_steps  # type: ignore[attr-defined]
    unknown.tactile_graph_stpes = tactile_graph_stpes  # type: ignore[attr-defined]
    found = offered(("a", lambda: raising), ("b", lambda: unknown), GOOD)
    assert found.plugins[0].error.startswith("RuntimeError: later (")
    assert found.plugins[1].error == (
        "unknown hook 'tactile_graph_stpes'; did you mean 'tactile_graph_steps'?"
    )
    assert found.names("steps") == ["step"]


def test_a_plugin_that_answers_a_hook_twice_offers_both() -> None:
    def more(name: str, hook: str) -> tuple[str, Callable[[], types.ModuleType]]:
        loader = plugin(steps={"a": step})
        mark = hookimpl(specname=f"tactile_graph_{hook}")
        vars(loader())["more"] = mark(_returning({name: step}))
        return "twice", loader

    assert offered(more("b", "steps")).names("steps") == ["a", "b"]
    found = offered(more("a", "steps"), GOOD)
    assert found.plugins[0].error == "hook tactile_graph_steps: 'a' is offered twice"
    assert found.names("steps") == ["step"]
    told = "unknown hook 'tactile_graph_stpes'; did you mean 'tactile_graph_steps'?"
    assert offered(more("b", "stpes")).plugins[0].error == told


def test_what_goes_around_a_hook_or_may_be_unknown_takes_nothing_away() -> None:
    loader = plugin(steps={"a": step})

    @hookimpl(wrapper=True, specname="tactile_graph_steps")
    def around() -> Any:
        return (yield)

    later = hookimpl(specname="tactile_graph_later", optionalhook=True)(_returning({}))
    vars(loader()).update(around=around, later=later)
    found = offered(("wraps", loader))
    assert found.plugins[0].error == ""
    assert found.names("steps") == ["a"]


def test_a_hook_without_its_mark_is_reported() -> None:
    module = types.ModuleType("bare")
    module.tactile_graph_steps = lambda: {"a": "b:c"}  # type: ignore[attr-defined]
    found = offered(("bare", lambda: module), GOOD)
    assert found.plugins[0].error == "tactile_graph_steps lacks @hookimpl, so nobody asks it"
    assert found.names("steps") == ["step"]


def test_an_entry_point_whose_module_is_gone_says_what_to_do() -> None:
    found = offered(("old", lambda: importlib.import_module("tg_gone_for_good")))
    assert found.plugins[0].error.startswith("No module named 'tg_gone_for_good' (")
    gone = EntryPoint("old", "tg_gone_for_good", "tactile_graph")
    assert offered(("old", gone.load)).plugins[0].error == (
        "No module named 'tg_gone_for_good'; its entry point is stale: "
        "install old-package again, or uninstall it"
    )


def test_entry_points_in_a_group_of_nearly_our_name_are_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    info = tmp_path / "astray-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: astray\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text("[tactile-graph]\nx = astray\n[other]\ny = astray\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    assert near_groups("tactile_graph") == [
        "package astray has its entry point 'x' in the group 'tactile-graph'; "
        "the group is 'tactile_graph'"
    ]


def test_a_plugin_may_offer_nothing() -> None:
    assert offered(("empty", lambda: types.ModuleType("empty"))).plugins[0].error == ""


# -- steps by import string --------------------------------------------------------------------


@pytest.fixture
def lazy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Registry]:
    (tmp_path / "lazily_loaded.py").write_text(
        "from tactile_graph import Image\nnumber = 3\n"
        "def double(image: Image) -> Image: return image\n"
    )
    (tmp_path / "lazily_broken.py").write_text("raise SystemExit('no licence')\n")
    monkeypatch.syspath_prepend(tmp_path)
    names = {
        "double": "lazily_loaded:double",
        "broken": "lazily_broken:x",
        "odd": "lazily_loaded",
        "number": "lazily_loaded:number",
        "gone": "lazily_loaded:gone",
    }
    yield offered(("lazy", plugin(steps=names)))
    for name in ("lazily_loaded", "lazily_broken"):
        sys.modules.pop(name, None)


def test_a_step_is_imported_when_it_is_used(lazy: Registry) -> None:
    assert lazy.names("steps") == ["broken", "double", "gone", "number", "odd"]
    assert "lazily_loaded" not in sys.modules
    assert lazy.step("double").ports[0].type is Image
    assert "lazily_loaded" in sys.modules
    assert lazy.step("double") is lazy.step("double")


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("broken", r"'broken' of plugin 'lazy' .*: cannot import lazily_broken: SystemExit: no l"),
        ("odd", "'lazily_loaded' is no import string 'module:name'"),
        ("number", "step 'number': 3 is not a function or class"),
        ("gone", r"'gone' of plugin 'lazy' \(package lazy-package\): lazily_loaded has no 'gone'"),
    ],
)
def test_a_step_that_cannot_be_had_is_told(lazy: Registry, name: str, message: str) -> None:
    with pytest.raises(PluginError, match=message):
        lazy.step(name)


# -- which plugins -----------------------------------------------------------------------------

OTHER = ("other", plugin(steps={"more": step}))


@pytest.mark.parametrize(
    ("select", "names"),
    [
        ("", ["more", "step"]),
        ("good", ["step"]),
        ("-good", ["more"]),
        (" other , good ", ["more", "step"]),
        ("good,-good", []),
        ("-good,-other", []),
        (",", ["more", "step"]),
    ],
)
def test_a_selection_names_the_plugins_to_load_or_to_block(select: str, names: list[str]) -> None:
    assert offered(GOOD, OTHER, select=select).names("steps") == names


def test_a_blocked_plugin_is_not_imported() -> None:
    found = offered(("bad", broken(ImportError("x"))), GOOD, select="-bad")
    assert (found.plugins[0].blocked, found.plugins[0].error) == (True, "")


@pytest.fixture
def fresh(monkeypatch: pytest.MonkeyPatch) -> Iterator[pytest.MonkeyPatch]:
    monkeypatch.setattr(registry_module, "_override", None)
    installed.cache_clear()
    yield monkeypatch
    installed.cache_clear()


def test_the_environment_and_the_flag_restrict_plugins(fresh: pytest.MonkeyPatch) -> None:
    fresh.setenv("TACTILE_GRAPH_PLUGINS", "filters")
    assert {p.name for p in installed().plugins if not p.blocked} == {"core", "filters"}
    restrict("-filters")
    left = {p.name: p.blocked for p in installed().plugins}
    assert left["filters"]
    assert not left["sources"]


def test_the_installed_plugins_load_without_trouble(fresh: pytest.MonkeyPatch) -> None:
    fresh.delenv("TACTILE_GRAPH_PLUGINS", raising=False)
    found = installed()
    ours = [p for p in found.plugins if p.package == "tactile-graph"]
    assert [p.error for p in ours] == [""] * len(ours)
    assert found.clashes == []
    assert ours[0].name == "core"
    assert [p.name for p in ours[1:]] == sorted(p.name for p in ours[1:])
