"""A new package of each kind installs, passes its own tests, checks and types, and runs."""

from __future__ import annotations

import os
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path
from shutil import which
from typing import NamedTuple

import pytest
from click.testing import CliRunner, Result

from tactile_graph.cli import cli
from tactile_graph.cli.package.kinds import KINDS
from tactile_graph.cli.package.making import words_of
from tactile_graph.cli.package.names import LONGEST_PACKAGE, LONGEST_STEP, names_of


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
    """Packages in a folder, as if installed."""

    folder: Path
    env: dict[str, str]


def as_installed(folder: Path, *packages: tuple[str, str, str]) -> Installed:
    """Make packages of (project, step, kind), with what installing writes of them.

    No network is asked.
    """
    paths = []
    for project, step, kind in packages:
        got = made(folder, project, "--kind", kind, "--step", step)
        assert got.exit_code == 0, got.output
        (src,) = (folder / project).glob("src/*")
        about = src.with_name(f"{src.name}-0.1.0.dist-info")
        about.mkdir()
        name = f"Metadata-Version: 2.1\nName: {project}\nVersion: 0.1.0\n"
        (about / "METADATA").write_text(name)
        (about / "entry_points.txt").write_text(f"[tactile_graph]\n{step} = {src.name}\n")
        paths.append(str(src.parent))
    path = os.pathsep.join([*paths, os.environ.get("PYTHONPATH", "")]).rstrip(os.pathsep)
    return Installed(folder, {**os.environ, "PYTHONPATH": path})


def pass_their_tests(installed: Installed) -> None:
    options = ["-q", "-p", "no:cacheprovider", "--import-mode=importlib", "-W", "error"]
    words = [str(p.relative_to(installed.folder)) for p in installed.folder.glob("*/tests")]
    said = done(["pytest", *options, *sorted(words)], installed.folder, installed.env)
    assert "passed" in said


def are_clean(installed: Installed) -> None:
    done(["ruff", "check", "."], installed.folder, installed.env)
    done(["ruff", "format", "--check", "."], installed.folder, installed.env)


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Installed:
    """Make a package of each kind."""
    packages = [(f"tactile-graph-my{kind}", f"my{kind}", kind) for kind in KINDS]
    return as_installed(tmp_path_factory.mktemp("packages"), *packages)


@pytest.mark.slow
def test_new_packages_pass_their_own_tests(installed: Installed) -> None:
    pass_their_tests(installed)


ORDINARY = (
    ("filter", "image found values"),
    ("stateful", "change settled step"),
    ("source", "frame report rng"),
    ("fitter", "line xy ends t"),
    ("reader", "path frames lines module"),
    ("restorer", "energy restored match"),
)


@pytest.mark.slow
def test_a_step_may_be_called_by_a_word_that_the_package_uses(tmp_path: Path) -> None:
    named = [(f"{kind}-{step}", step, kind) for kind, steps in ORDINARY for step in steps.split()]
    pass_their_tests(as_installed(tmp_path, *named))


@pytest.mark.slow
@pytest.mark.parametrize("kind", list(KINDS))
def test_a_new_package_runs_as_it_says(installed: Installed, kind: str) -> None:
    folder = installed.folder / f"tactile-graph-my{kind}"
    words = words_of(names_of(folder.name + "2", f"my{kind}2", kind), kind)["try_it"]
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
    are_clean(installed)
    folders = sorted(installed.folder.glob("*/src"))
    env = {**installed.env, "MYPYPATH": os.pathsep.join(map(str, folders))}
    packages = [w for kind in KINDS for w in ("-p", f"tactile_graph_my{kind}")]
    done(["mypy", "--strict", *packages], installed.folder, env)


@pytest.mark.slow
@pytest.mark.skipif(not find_spec("ruff"), reason="ruff is missing")
@pytest.mark.parametrize(
    ("package", "step"),
    [(1, 1), (1, LONGEST_STEP), (LONGEST_PACKAGE, 1), (LONGEST_PACKAGE, LONGEST_STEP)],
)
def test_no_line_of_a_package_is_too_long_or_short_for_its_workflow(
    tmp_path: Path, package: int, step: int
) -> None:
    for letter, kind in zip("bcdefghij", KINDS, strict=False):
        got = made(tmp_path, letter * package, "--kind", kind, "--step", letter * step)
        assert got.exit_code == 0, got.output
    are_clean(Installed(tmp_path, dict(os.environ)))


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
        (["mine", "--step", "Deep-Blue"], "name another by --step, such as deep_blue"),
        (["mine", "--step", "hull"], "name another by --step, such as my_hull"),
        (["mine", "--step", "__init__"], "a step cannot be called '__init__'"),
        (["mine", "--step", "größe"], "a step cannot be called 'größe'"),
        (["mine", "--step", ""], "a step cannot be called ''"),
        (["mine", "--step", "s" * 25], "a step's name has at most 24 letters, got 25"),
        (["tactile-graph-on"], "'on': in a pipeline file that is no name but a value"),
        (["mine", "--step", "null"], "--step, such as my_null"),
        (["tactile-graph-class"], "a step cannot be called 'class'"),
        (["tactile-graph-np"], "kind filter cannot be called 'np': its package uses 'np'"),
        (["mine", "--step", "float"], "its package uses 'float'"),
        (["mine", "--step", "image", "--kind", "stateful"], "its package uses 'Image'"),
        (["mine", "--step", "range", "--kind", "source"], "--step, such as my_range"),
        (["mine", "--step", "hookimpl"], "its package uses 'hookimpl'"),
        (["filters"], "there is a plugin 'filters' (package tactile-graph) already"),
        (["PyYAML"], "package PyYAML is installed already"),
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


def test_a_link_that_leads_nowhere_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "mine").symlink_to("nowhere")
    assert "mine is there already; choose another name" in made(tmp_path, "mine").output
    assert (tmp_path / "mine").is_symlink()


def test_a_folder_that_cannot_be_written_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object, **__: object) -> None:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "mkdir", refuse)
    got = made(tmp_path, "mine")
    assert got.exit_code == 2
    assert "mine: cannot be written: Permission denied" in got.output


def test_within_a_repository_it_says_where_the_workflow_runs(tmp_path: Path) -> None:
    assert "git repository" not in made(tmp_path, "mine").output
    (tmp_path / ".git").mkdir()
    (tmp_path / "plugins").mkdir()
    said = f"It lies in the git repository {tmp_path.resolve()}: GitHub runs its workflow only"
    assert said in made(tmp_path / "plugins", "mine").output


@pytest.mark.skipif(not which("git"), reason="git is missing")
def test_nothing_of_a_package_is_ignored_by_git_whatever_it_is_called(tmp_path: Path) -> None:
    assert made(tmp_path, "dist").exit_code == 0
    subprocess.run(["git", "init", "-q", str(tmp_path)], check=True)
    words = ["git", "status", "--short", "--ignored", "--untracked-files=all"]
    got = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True, check=True)
    assert "dist/src/dist/__init__.py" in got.stdout
    assert "!!" not in got.stdout


def test_the_step_is_called_after_the_package_without_what_all_begin_with() -> None:
    assert names_of("Tactile.Graph-deep_blue", None, "filter") == (
        "Tactile.Graph-deep_blue", "tactile_graph_deep_blue", "deep_blue"
    )  # fmt: skip
    assert names_of("tactile-graph-x", "soft_x", "filter").type_name == "SoftX"
