"""The example package, built and installed beside the project's wheel in a clean environment."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import sysconfig
import venv
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).parents[2]
pytestmark = pytest.mark.slow  # it makes environments and installs both wheels
EXAMPLE = ROOT / "examples" / "tactile-graph-median"
PIPELINE = """\
pipeline: mine
nodes:
  steady: {step: median, in: frame, with: {reach: 1}}
  footprint: {step: threshold, in: steady, with: {level: 0.6}}
outputs: [steady, footprint]
"""

Run = Callable[..., "subprocess.CompletedProcess[str]"]


def _environment() -> dict[str, str]:
    clean = {
        k: v for k, v in os.environ.items() if not k.startswith(("PYTHON", "TACTILE", "PYTEST"))
    }
    return {**clean, "PIP_DISABLE_PIP_VERSION_CHECK": "1", "COLUMNS": "120"}


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the scripts folder of a new environment that holds both wheels.

    Their dependencies come from the environment the tests run in, through a ``.pth`` file: its own
    ``.pth`` files, and so an editable install of the project, do not count there.
    """
    folder = tmp_path_factory.mktemp("clean")
    pip = [sys.executable, "-m", "pip", "-q"]
    isolation = ["--no-build-isolation"] if find_spec("hatchling") else []
    build = [*pip, "wheel", "--no-deps", *isolation, "-w", str(folder / "wheels")]
    built = subprocess.run(
        [*build, str(ROOT), str(EXAMPLE)],
        capture_output=True,
        text=True,
        env=_environment(),
        cwd=folder,
    )
    if built.returncode:
        pytest.skip(f"pip cannot build wheels here: {built.stderr.strip()[-300:]}")
    home = folder / "venv"
    venv.create(home, with_pip=False)
    scripts = home / ("Scripts" if os.name == "nt" else "bin")
    python = scripts / "python"
    wheels = sorted(str(w) for w in (folder / "wheels").glob("*.whl"))
    subprocess.run(
        [
            *pip,
            "--python",
            str(python),
            "install",
            "--no-compile",
            "--no-deps",
            "--no-index",
            *wheels,
        ],
        check=True,
        capture_output=True,
        env=_environment(),
    )
    where = subprocess.run(
        [python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))"],
        capture_output=True,
        text=True,
        check=True,
        env=_environment(),
    )
    site = Path(where.stdout.strip())
    (site / "dependencies.pth").write_text(f"{sysconfig.get_path('purelib')}\n")
    return scripts


@pytest.fixture(scope="module")
def run(installed: Path, tmp_path_factory: pytest.TempPathFactory) -> Run:
    folder = tmp_path_factory.mktemp("work")

    def call(program: str, *words: str, cwd: Path = folder) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [str(installed / program), *words],
            capture_output=True,
            text=True,
            env=_environment(),
            cwd=cwd,
            timeout=60,
        )

    return call


def test_both_are_installed_and_not_taken_from_a_checkout(run: Run, installed: Path) -> None:
    code = (
        "import tactile_graph, tactile_graph_median as m; print(tactile_graph.__file__, m.__file__)"
    )
    found = run("python", "-c", code)
    assert found.stderr == ""
    assert all(Path(f).is_relative_to(installed.parent) for f in found.stdout.split())
    marks = installed.parent.rglob("tactile_graph_median/py.typed")
    assert list(marks)


def test_the_plugin_is_found_with_its_package(run: Run) -> None:
    code = (
        "from tactile_graph.plugins.registry import installed\n"
        "p = {p.name: p for p in installed().plugins}['median']\n"
        "print(p.package, p.version, repr(p.error), installed().clashes)"
    )
    found = run("python", "-c", code)
    assert (found.stdout.strip(), found.stderr) == ("tactile-graph-median 1.0.0 '' []", "")


def test_its_step_runs_in_a_yaml_pipeline_from_the_command_line(run: Run, tmp_path: Path) -> None:
    (tmp_path / "mine.yaml").write_text(PIPELINE)
    values = np.zeros((2, 6, 6))
    values[:, 1:4, 1:4] = 1.0
    values[1, 5, 5] = 7.0  # a stuck cell that the median takes out
    np.save(tmp_path / "recording.npy", values)
    found = run(
        "tactile-graph", "run", "mine.yaml", "recording.npy", "--format", "jsonl", cwd=tmp_path
    )
    assert found.returncode == 0, found.stderr
    rows = [json.loads(line) for line in found.stdout.splitlines()]
    assert [row["frame"] for row in rows] == [0, 1]
    counts = [row["outputs"]["footprint"]["count"] for row in rows]
    assert counts == [5, 5]


def test_the_pipeline_it_ships_is_found_by_name_and_runs(run: Run, tmp_path: Path) -> None:
    np.save(tmp_path / "recording.npy", np.pad(np.ones((1, 4, 4)), ((0, 0), (3, 3), (3, 3))))
    found = run(
        "tactile-graph",
        "run",
        "steady-contacts",
        "recording.npy",
        "--format",
        "jsonl",
        cwd=tmp_path,
    )
    assert found.returncode == 0, found.stderr
    assert json.loads(found.stdout)["outputs"]["contacts"]["count"] == 1


def test_its_own_tests_pass(run: Run) -> None:
    found = run("python", "-m", "pytest", "-q", "-p", "no:cacheprovider", "tests", cwd=EXAMPLE)
    assert found.returncode == 0, found.stdout + found.stderr
    assert " passed" in found.stdout


def test_it_withstands_what_steps_are_stressed_with(run: Run) -> None:
    found = run("tactile-graph", "stress", "median")
    assert found.returncode == 0, found.stdout + found.stderr
