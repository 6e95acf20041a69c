"""A new package of each kind installs, passes its own tests, checks and types, and runs."""

from __future__ import annotations

import os
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple

import pytest
from click.testing import CliRunner, Result

from tactile_graph.cli import cli
from tactile_graph.cli.package.kinds import KINDS
from tactile_graph.cli.package.making import names_of, words_of


def made(folder: Path, *words: str) -> Result:
    return CliRunner().invoke(cli, ["new", *words, "--into", str(folder)])


def done(words: list[str], folder: Path, env: dict[str, str]) -> str:
    got = subprocess.run(
        [sys.executable, "-m", *words], cwd=folder, env=env, capture_output=True, text=True,
        check=False, timeout=300,
    )  # fmt: skip
    assert got.returncode == 0, got.stdout + got.stderr
    return got.stdout + got.stderr


class Installed(NamedTuple):
    """A package of each kind, as if installed."""

    folder: Path
    env: dict[str, str]


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Installed:
    """Make the packages, with what installing writes of them; no network is asked."""
    folder, paths = tmp_path_factory.mktemp("packages"), []
    for kind in KINDS:
        assert made(folder, f"tactile-graph-my{kind}", "--kind", kind).exit_code == 0
        package = f"tactile_graph_my{kind}"
        src = folder / f"tactile-graph-my{kind}" / "src"
        about = src / f"{package}-0.1.0.dist-info"
        about.mkdir()
        name = f"Metadata-Version: 2.1\nName: tactile-graph-my{kind}\nVersion: 0.1.0\n"
        (about / "METADATA").write_text(name)
        (about / "entry_points.txt").write_text(f"[tactile_graph]\nmy{kind} = {package}\n")
        paths.append(str(src))
    path = os.pathsep.join([*paths, os.environ.get("PYTHONPATH", "")]).rstrip(os.pathsep)
    return Installed(folder, {**os.environ, "PYTHONPATH": path})


@pytest.mark.slow
def test_new_packages_pass_their_own_tests(installed: Installed) -> None:
    words = [f"tactile-graph-my{kind}/tests" for kind in KINDS]
    options = ["-q", "-p", "no:cacheprovider", "--import-mode=importlib", "-W", "error"]
    said = done(["pytest", *options, *words], installed.folder, installed.env)
    assert "passed" in said


@pytest.mark.slow
@pytest.mark.parametrize("kind", list(KINDS))
def test_a_new_package_runs_as_it_says(installed: Installed, kind: str) -> None:
    folder = installed.folder / f"tactile-graph-my{kind}"
    words = words_of(names_of(folder.name + "2", f"my{kind}2"), kind)["try_it"]
    done(["tactile_graph", *words.replace("2", "").split()], folder, installed.env)
    assert (folder / "strip.png").stat().st_size > 10_000


@pytest.mark.slow
def test_new_plugins_are_listed_with_nothing_wrong(installed: Installed) -> None:
    said = done(["tactile_graph", "plugins"], installed.folder, installed.env)
    assert all(f"my{kind}" in said for kind in KINDS)
    assert not any(word in said for word in ("failed", "cannot", "clash", "not found"))
    demos = [f"my{kind}-demo" for kind in KINDS if kind != "reader"]
    done(["tactile_graph", "check", *demos], installed.folder, installed.env)


@pytest.mark.slow
@pytest.mark.skipif(not (find_spec("mypy") and find_spec("ruff")), reason="ruff or mypy is missing")
def test_new_packages_are_clean_and_typed(installed: Installed) -> None:
    done(["ruff", "check", "."], installed.folder, installed.env)
    done(["ruff", "format", "--check", "."], installed.folder, installed.env)
    folders = sorted(installed.folder.glob("*/src"))
    env = {**installed.env, "MYPYPATH": os.pathsep.join(map(str, folders))}
    packages = [w for kind in KINDS for w in ("-p", f"tactile_graph_my{kind}")]
    done(["mypy", "--strict", *packages], installed.folder, env)


def test_it_says_what_was_made_and_what_to_do_next(tmp_path: Path) -> None:
    got = made(tmp_path, "tactile-graph-flatten")
    assert got.exit_code == 0
    folder = tmp_path / "tactile-graph-flatten"
    listed = [line.strip() for line in got.output.splitlines()]
    files = {str(p.relative_to(folder)) for p in folder.rglob("*") if p.is_file()}
    assert files <= set(listed)
    assert "src/tactile_graph_flatten/flatten.py" in files
    assert "tactile-graph run flatten-demo --plot strip.png" in listed
    assert not any("$" in p.read_text() for p in folder.rglob("*.py"))
    assert [p.name for p in tmp_path.iterdir()] == [folder.name]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["my step"], "a package cannot be called 'my step': letters, digits"),
        (["7up"], "a package cannot be called '7up': small letters"),
        (["class"], "a package cannot be called 'class'"),
        (["json"], "there is a module 'json' already"),
        (["tactile-graph-hull"], "there is a module 'tactile_graph_hull' already"),
        (["tactile-graph-threshold"], "has a step 'threshold' already; name another by --step"),
        (["mine", "--step", "hull"], "has a step 'hull' already"),
        (["mine", "--step", "Hull"], "a step cannot be called 'Hull'"),
        (["m" * 39], "a package's name has at most 38 letters, got 39"),
        (["mine", "--kind", "filtr"], "'filtr' is not one of 'filter'"),
        (["mine", "--into", "nowhere"], "Directory 'nowhere' does not exist"),
    ],
)
def test_a_name_that_cannot_be_is_refused(tmp_path: Path, words: list[str], said: str) -> None:
    got = CliRunner().invoke(cli, ["new", "--into", str(tmp_path), *words])
    assert got.exit_code == 2
    assert said in got.output.replace("\n", " ")
    assert not list(tmp_path.iterdir())


def test_a_folder_that_is_there_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "mine").mkdir()
    got = made(tmp_path, "mine")
    assert got.exit_code == 2
    assert "mine is there already; choose another name, or --into a folder" in got.output
    assert not list((tmp_path / "mine").iterdir())


def test_the_step_is_called_after_the_package_without_what_all_begin_with() -> None:
    assert names_of("Tactile.Graph-deep_blue", None) == (
        "Tactile.Graph-deep_blue", "tactile_graph_deep_blue", "deep_blue"
    )  # fmt: skip
    assert names_of("tactile-graph-x", "soft_x").type_name == "SoftX"
