"""The seven plugins of one file each: short, right, and run by the commands they say."""

from __future__ import annotations

import ast
import importlib
import importlib.util
import os
import re
import shlex
import subprocess
import sys
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from helpers_cli import call
from tactile_graph import Circle, Points, Skip, load
from tactile_graph.plugins import registry
from tactile_graph.plugins.names import OWN
from tactile_graph.plugins.registry import Registry
from tactile_graph.testing import check_step, run_step

FOLDER = Path(__file__).parents[2] / "examples" / "seven-plugins" / "src" / "seven_plugins"
FILES = sorted(p for p in FOLDER.glob("*.py") if p.stem != "__init__")
NAMES = [p.stem for p in FILES]
PIPELINES = sorted(p.stem for p in (FOLDER / "pipelines").glob("*.yaml"))
pytestmark = pytest.mark.skipif(not FILES, reason="the examples are not beside the tests")


def module(name: str) -> ModuleType:
    """Return a plugin as its entry point would have it imported."""
    full = f"seven_plugins.{name}"
    if full not in sys.modules:
        package = importlib.util.spec_from_file_location(
            "seven_plugins", FOLDER / "__init__.py", submodule_search_locations=[str(FOLDER)]
        )
        assert package is not None
        sys.modules.setdefault("seven_plugins", importlib.util.module_from_spec(package))
    return importlib.import_module(full)


def offering(*names: str) -> Registry:
    """Return the project's own plugins and some of the seven."""
    own = [row for row in registry.found_plugins() if row[1] == OWN]
    more = [(n.replace("_", "-"), "seven", "1", partial(module, n)) for n in names]
    return Registry([*own, *more])


@pytest.fixture
def all_seven(monkeypatch: pytest.MonkeyPatch) -> Iterator[Registry]:
    """The seven beside the project's own, as the installed plugins."""
    found = offering(*NAMES)
    monkeypatch.setattr(registry, "installed", lambda: found)
    return found


def test_there_are_seven_and_each_is_under_60_lines() -> None:
    assert len(FILES) == 7
    assert [p.name for p in FILES if len(p.read_text().splitlines()) >= 60] == []


@pytest.mark.parametrize("name", NAMES)
def test_each_loads_by_itself_and_its_steps_keep_the_promises(name: str) -> None:
    found = offering(name)
    (plugin,) = (p for p in found.plugins if p.package == "seven")
    assert (plugin.error, found.clashes) == ("", [])
    for step in plugin.offers["steps"]:
        if step != "png":  # a source is tried by running it
            check_step(step, registry=found)


@pytest.mark.parametrize("name", PIPELINES)
def test_each_pipeline_gives_answers(all_seven: Registry, name: str) -> None:
    results = list(load(name, all_seven).stream())
    assert [f.reason for r in results for f in r.failures] == []
    assert any(all(name in result for name in result.plan.asked) for result in results)


def commands(name: str) -> list[list[str]]:
    doc = ast.get_docstring(ast.parse((FOLDER / f"{name}.py").read_text()), clean=False) or ""
    return [shlex.split(line)[1:] for line in re.findall(r"^    (tactile-graph .*)", doc, re.M)]


@pytest.mark.slow  # many processes
@pytest.mark.parametrize("name", NAMES)
def test_the_command_in_the_first_lines_of_each_runs(
    all_seven: Registry, name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    shots(tmp_path)
    assert commands(name)
    for words in commands(name):
        given = [p for w in words for p in (sorted(map(str, Path().glob(w))) if "*" in w else [w])]
        got = call(*given)
        assert got.exit_code == 0, got.output + str(got.exception)


@pytest.mark.slow  # pip builds and installs the package
def test_installed_together_all_are_found_and_a_first_line_runs(tmp_path: Path) -> None:
    pip = [
        sys.executable,
        "-m",
        "pip",
        "install",
        "-q",
        "--no-compile",
        "--no-deps",
        "--target",
        str(tmp_path),
    ]
    isolation = ["--no-build-isolation"] if importlib.util.find_spec("hatchling") else []
    built = subprocess.run(
        [*pip, *isolation, str(FOLDER.parents[1])], capture_output=True, text=True
    )
    if built.returncode:
        pytest.skip(f"pip cannot build the package here: {built.stderr.strip()[-300:]}")
    code = "from tactile_graph.cli import main; main()"
    environment = {**os.environ, "PYTHONPATH": str(tmp_path), "COLUMNS": "120"}

    def run(*words: str) -> subprocess.CompletedProcess[str]:
        line = [sys.executable, "-c", code, *words]
        return subprocess.run(line, capture_output=True, text=True, env=environment, cwd=tmp_path)

    listed = run("plugins").stdout
    assert [n for n in NAMES if n.replace("_", "-") not in listed] == []
    assert listed.count("tactile-graph-seven-plugins") == 7
    (words,) = commands("running_background")
    done = run(*words)
    assert (done.returncode, "warming up: frame 1 of 3" in done.stdout) == (0, True), done.stderr


def shots(folder: Path) -> None:
    from PIL import Image as Pixels

    values = np.zeros((8, 8), np.uint16)
    values[2:5, 3:6] = 4000
    for k in range(2):
        Pixels.fromarray(np.roll(values, k, axis=1)).save(folder / f"shot-{k}.png")
    Pixels.new("RGB", (4, 4)).save(folder / "colour.png")


def test_the_background_says_why_it_skips() -> None:
    step = module("running_background").RunningBackground(warm_up=1)
    with pytest.raises(Skip, match="warming up: frame 1 of 1"):
        run_step_of(step, np.ones((2, 2)))
    assert run_step_of(step, np.full((2, 2), 3.0)).values.tolist() == [[2.0, 2.0], [2.0, 2.0]]


def run_step_of(step: object, values: np.ndarray) -> object:
    from tactile_graph import Image

    return step(Image(values))  # type: ignore[operator]


def test_pngs_are_read_as_frames_and_a_colour_one_is_refused(
    all_seven: Registry, tmp_path: Path
) -> None:
    shots(tmp_path)
    paths = [str(tmp_path / f"shot-{k}.png") for k in range(2)]
    pipeline = load("contacts", all_seven)
    frames = list(pipeline.with_source("png", path=paths, pitch_cm=0.5).frames())
    assert [f.image.peak for f in frames] == [4000.0, 4000.0]
    assert frames[1].image.values[2, 4:7].tolist() == [4000.0] * 3
    wrong = pipeline.with_source("png", path=str(tmp_path / "colour.png"))
    with pytest.raises(Exception, match="is no grey image: it has 3 channels"):
        list(wrong.frames())


def test_wild_points_do_not_move_the_median_circle() -> None:
    fit = module("fitter_beside_fit_circle").fit_circle_median
    angle = np.linspace(0.0, 2 * np.pi, 40, endpoint=False)
    xy = np.array([5.0, 6.0]) + 3.0 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    xy[::8] += 4.0  # five of forty
    found = run_step(fit, Points(xy))
    assert isinstance(found, Circle)
    assert (found.x_cm, found.y_cm, found.radius_cm) == pytest.approx((5.0, 6.0, 3.0), abs=0.05)
