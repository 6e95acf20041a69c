"""Names that two plugins offer, from the command line: never a silent winner."""

from __future__ import annotations

import types
from collections.abc import Callable
from pathlib import Path

import pytest

from helpers_cli import DISCS, call, disc, install
from tactile_graph import Circle, Mask, hookimpl
from tactile_graph.plugins import registry

BOTH = (
    "plugin 'hand' (package hand-made) and plugin 'twin' (package twin-package) offer it; "
    "write hand.{0} or twin.{0}"
)


def twin(folder: Path) -> Callable[[], types.ModuleType]:
    def twin_disc(mask: Mask, *, radius_cm: float = 7.0) -> Circle:
        """Return a circle of a radius."""
        return Circle(1.0, 1.0, radius_cm)

    module = types.ModuleType("twin")
    folder.mkdir()
    path = folder / "discs.yaml"
    path.write_text(DISCS.replace("step: pressed", "step: hand.pressed"))

    @hookimpl
    def tactile_graph_steps() -> dict[str, object]:
        return {"disc": twin_disc}

    @hookimpl
    def tactile_graph_pipelines() -> dict[str, Path]:
        return {"discs": path}

    for hook in (tactile_graph_steps, tactile_graph_pipelines):
        setattr(module, hook.__name__, hook)
    return lambda: module


@pytest.fixture
def two(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Two plugins that both offer the step ``disc`` and the pipeline ``discs``."""
    more = ("twin", "twin-package", "2", twin(tmp_path / "twin"))
    install(monkeypatch, tmp_path, more)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("tactile_graph.compiled.warm_up", lambda: None)
    return tmp_path


@pytest.fixture(autouse=True)
def _found_anew() -> object:
    yield
    registry.installed.cache_clear()


def radius_of(*words: str) -> float:
    got = call("run", *words, "--frames", "1", "--format", "csv")
    assert got.exit_code == 0, got.stderr
    head, row = (line.split(",") for line in got.stdout.splitlines()[:2])
    return float(row[head.index("circle.radius_cm")])


@pytest.mark.usefixtures("two")
def test_run_says_which_pipelines_a_name_may_mean() -> None:
    got = call("run", "discs")
    assert got.exit_code == 2
    assert f"pipeline 'discs' is ambiguous: {BOTH.format('discs')}" in got.stderr


@pytest.mark.usefixtures("two")
def test_each_is_run_by_its_plugins_name_with_its_own_steps() -> None:
    assert radius_of("hand.discs") == pytest.approx((4 / 3.141592653589793) ** 0.5)
    assert radius_of("twin.discs") == 7.0


def test_a_file_of_ones_own_says_which_step_it_means(two: Path) -> None:
    mine = two / "mine.yaml"
    mine.write_text(DISCS)
    got = call("run", "mine.yaml")
    assert got.exit_code == 2
    assert f"mine.yaml:6:18: node 'circle': step 'disc' is ambiguous: {BOTH.format('disc')}" in (
        got.stderr
    )
    mine.write_text(DISCS.replace("step: disc", "step: twin.disc"))
    assert radius_of("mine.yaml") == 7.0
    assert call("check", "mine.yaml").exit_code == 0
    mine.write_text(DISCS.replace("step: disc", "step: twin.dics"))
    assert "no step named 'twin.dics'; did you mean 'twin.disc'?" in call("check", mine).stdout


def test_use_and_evolves_take_qualified_names(two: Path) -> None:
    mine = two / "mine.yaml"
    text = "pipeline: mine\nevolves: {0}\nnodes: {{circle: {{use: {0}}}}}\noutputs: [circle]\n"
    mine.write_text(text.format("discs"))
    told = call("check", "mine.yaml").stdout
    assert "'evolves': pipeline 'discs' is ambiguous" in told
    assert "pipeline 'discs' cannot be used: pipeline 'discs' is ambiguous" in told
    mine.write_text(text.format("twin.discs"))
    assert radius_of("mine.yaml", "--source", "hand.made") == 7.0


@pytest.mark.usefixtures("two")
def test_lists_and_pages_take_and_show_them() -> None:
    page = call("steps", "twin.disc").stdout
    assert "twin.disc" in page
    assert "Return a circle of a radius." in page
    assert "step 'disc' is ambiguous" in call("steps", "disc").stderr
    listed = call("pipelines").stdout
    assert "hand.discs" in listed
    assert "└─ loads" in listed  # below the one of its own package
    assert call("pipelines", "twin.discs").stdout == (Path("twin/discs.yaml")).read_text()
    assert call("explain", "twin.discs", "--frame", "0").exit_code == 0


def test_a_name_that_one_plugin_offers_may_be_qualified_too(two: Path) -> None:
    assert call("steps", "hand.pressed").exit_code == 0
    assert registry.installed().step("hand.disc").target is disc


def test_the_schema_takes_both_names_and_knows_each_steps_settings(two: Path) -> None:
    import json

    import jsonschema
    import yaml

    made = json.loads(call("schema").stdout)
    for node, right in {
        "{step: twin.disc, in: frame, with: {radius_cm: 3}}": True,
        "{step: hand.disc, in: frame, with: {radius_cm: 3}}": False,
        "{step: disc, in: frame}": False,
        "{step: hand.pressed, in: frame, with: {level_v: 3}}": True,
        "{step: hand.pressed, in: frame, with: {level_w: 3}}": False,
    }.items():
        text = f"pipeline: p\nnodes: {{a: {node}}}\noutputs: [a]\n"
        found = list(jsonschema.Draft202012Validator(made).iter_errors(yaml.safe_load(text)))
        assert (not found) == right, node
