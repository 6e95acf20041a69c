"""``plugins --check``: all that a plugin offers is imported and tried, and told in a line each."""

from __future__ import annotations

from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from tactile_graph import Mask, hookimpl
from tactile_graph.cli.plugin_check import show_checked
from tactile_graph.errors import UsageError
from tactile_graph.exporter import Exporter
from tactile_graph.plugins.registry import Registry
from tactile_graph.testing.plugin_check import examine_plugin

PIPELINE = """
pipeline: mine
nodes:
  a: {step: counted, in: frame}
  b: {step: nope, in: frame}
outputs: [a]
"""


def counted(mask: Mask) -> int:
    return mask.count


def shaky(mask: Mask) -> int:
    return int(mask.values.argmax())


def needy(mask: Mask, *, level: int) -> int:
    return level


def corner(mask: Mask) -> tuple[int, float]:
    return mask.count, mask.area_cm2


def counts(mask: Mask) -> tuple[int, ...]:
    return (mask.count,)


def offering(**offers: Any) -> ModuleType:
    module = ModuleType("mine")
    for kind, named in offers.items():

        def hook(named: Any = named) -> Any:
            return named

        hook.__name__ = f"tactile_graph_{kind}"
        setattr(module, hook.__name__, hookimpl(_without_parameters(hook)))
    return module


def _without_parameters(hook: Any) -> Any:
    def bare() -> Any:
        return hook()

    bare.__name__ = hook.__name__
    return bare


def registry_of(module: ModuleType) -> Registry:
    return Registry([("mine", "my-package", "1.2", lambda: module)])


def test_each_fault_is_a_line(tmp_path: Path) -> None:
    (tmp_path / "mine.yaml").write_text(PIPELINE)
    module = offering(
        steps={
            "counted": counted, "shaky": shaky, "needy": needy, "lost": "nowhere:lost",
        },
        pipelines={"mine": tmp_path / "mine.yaml"},
        commands={"gone": "os:gone"},
    )  # fmt: skip
    registry = registry_of(module)
    told: list[str] = []
    report = examine_plugin(registry.plugins[0], registry, told.append)
    assert told == [
        "step 'counted'", "step 'shaky'", "step 'needy'", "step 'lost'", "pipeline 'mine'",
        "command 'gone'",
    ]  # fmt: skip
    assert report.n_offers == 6
    assert list(report.untried) == ["needy"]
    shaky_line, lost, *pipeline, command = report.broken
    assert shaky_line.startswith("step 'shaky': an image without cells (and 1 more case): raises")
    assert "cannot import nowhere: No module named 'nowhere'" in lost
    assert any("no step named 'nope'" in line for line in pipeline)
    assert "os has no 'gone'" in command
    assert all("\n" not in line for line in report.broken)


MISTAKEN = Exporter("mine", "numbres", lambda export: None)  # type: ignore[arg-type,return-value]


def test_an_exporter_that_holds_nothing_known_is_told() -> None:
    registry = registry_of(offering(exporters={".mine": f"{__name__}:MISTAKEN"}))
    (line,) = examine_plugin(registry.plugins[0], registry).broken
    told = "it holds 'numbres', must be one of images, numbers, records; did you mean 'numbers'?"
    assert line == f"exporter '.mine': {told}"


def test_a_plugin_that_does_not_load_says_why() -> None:
    def broken() -> ModuleType:
        raise ImportError("no module named 'left_pad'")

    registry = Registry([("mine", "my-package", "1.2", broken)])
    report = examine_plugin(registry.plugins[0], registry)
    (line,) = report.broken
    assert line.startswith("no module named 'left_pad' (")


def test_a_taken_name_is_told() -> None:
    module = offering(steps={"counted": counted})
    registry = Registry(
        [("first", "one", "1", lambda: offering(steps={"counted": counted})),
         ("mine", "my-package", "1.2", lambda: module)]
    )  # fmt: skip
    for plugin in registry.plugins:
        report = examine_plugin(plugin, registry)
        assert (report.broken, report.n_offers) == ([], 1)
        (line,) = report.clashes
        assert line.startswith("step 'counted' is ambiguous: ")
        assert line.endswith("write first.counted or mine.counted")


def test_the_shell_shows_what_is_wrong_and_what_is_right(
    capsys: pytest.CaptureFixture[str],
) -> None:
    registry = registry_of(offering(steps={"counted": counted, "shaky": shaky, "needy": needy}))
    assert not show_checked(registry, ["mine"])
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "mine (my-package 1.2): 1 broken"
    assert lines[1].startswith("  step 'shaky': an image without cells")
    assert lines[2].startswith("  step 'needy' was not tried: setting 'level' is missing")
    assert show_checked(registry_of(offering(steps={"counted": counted})), [])
    assert capsys.readouterr().out == "mine (my-package 1.2): right  1 offer\n"


def test_of_a_tuple_without_names_it_is_told_what_names_would_give(
    capsys: pytest.CaptureFixture[str],
) -> None:
    registry = registry_of(offering(steps={"corner": corner, "counts": counts}))
    assert show_checked(registry, ["mine"])
    first, advice = capsys.readouterr().out.splitlines()
    assert first == "mine (my-package 1.2): right  2 offers"
    assert advice.startswith("  step 'corner' gives tuple[int, float], of which tables only show ")
    assert "; a NamedTuple gives each a name" in advice


def test_an_unknown_plugin_and_none_at_all_are_told() -> None:
    registry = Registry([("hull", "tactile-graph", "1", lambda: offering(steps={}))])
    with pytest.raises(UsageError, match="no plugin named 'hul'; did you mean 'hull'"):
        show_checked(registry, ["hul"])
    with pytest.raises(UsageError, match="no plugin of others is installed; --check NAME takes"):
        show_checked(registry, [])
