"""From an empty folder to a plugin with a quantity, a format, a shape of its own and a section.

Every command an author gives is given here; what the author writes is the example's. No network is
asked: installing, for which pip would fetch what builds packages, is done by hand.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import time
from importlib.util import find_spec
from pathlib import Path

import pytest

EXAMPLE = Path(__file__).parents[2] / "examples" / "tactile-graph-fingers"
PACKAGE = "tactile_graph_fingers"
SLOWEST_S = 300.0
pytestmark = [
    pytest.mark.slow,  # it types and tests a package
    pytest.mark.skipif(not EXAMPLE.is_dir(), reason="the examples are not beside the tests"),
    pytest.mark.skipif(
        not (find_spec("mypy") and find_spec("ruff")), reason="ruff or mypy is missing"
    ),
]


class Shell:
    """Gives an author's commands in a folder."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.env = {**os.environ, "COLUMNS": "120", "PYTHONDONTWRITEBYTECODE": "1"}
        self.spent_s: dict[str, float] = {}

    def __call__(self, *words: str, within: str = ".") -> str:
        start = time.perf_counter()
        got = subprocess.run(
            [sys.executable, "-m", *words], cwd=self.folder / within, env=self.env,
            capture_output=True, text=True, check=False, timeout=SLOWEST_S,
        )  # fmt: skip
        self.spent_s[" ".join(words[:3])] = round(time.perf_counter() - start, 1)
        assert got.returncode == 0, f"{words}\n{got.stdout}{got.stderr}"
        return got.stdout + got.stderr

    def install(self, src: Path) -> None:
        """Do what ``pip install -e .`` does: the package is found, and its entry point."""
        about = src / f"{PACKAGE}-0.1.0.dist-info"
        about.mkdir()
        name = "Metadata-Version: 2.1\nName: tactile-graph-fingers\nVersion: 0.1.0\n"
        (about / "METADATA").write_text(name)
        (about / "entry_points.txt").write_text(f"[tactile_graph]\nfit_stroke = {PACKAGE}\n")
        paths = [str(src), self.env.get("PYTHONPATH", "")]
        self.env["PYTHONPATH"] = os.pathsep.join(filter(None, paths))
        self.env["MYPYPATH"] = str(src)


def test_an_author_gets_from_an_empty_folder_to_an_installed_plugin(tmp_path: Path) -> None:
    shell, start = Shell(tmp_path), time.perf_counter()
    shell("tactile_graph", "new", "tactile-graph-fingers", "--kind=fitter", "--step=fit_stroke")
    folder = tmp_path / "tactile-graph-fingers"
    _write(folder)
    shell.install(folder / "src")
    assert "5 passed" in shell("pytest", "-p", "no:cacheprovider", within=folder.name)
    shell("ruff", "check", ".", within=folder.name)
    shell("ruff", "format", "--check", ".", within=folder.name)
    assert "Success" in shell("mypy", within=folder.name)
    assert "right  7 offers" in shell("tactile_graph", "plugins", "--check", "fit_stroke")

    (tmp_path / "pressed.txt").write_text("FINGERS 2 4 0.5\n50 50 50 0 0 0 0 0\n")
    told = shell("tactile_graph", "run", "fingers", "pressed.txt", "--plot", "strip.png")
    assert re.search(r"0\s+0\.750\s+0\.250\s+1\.000", told), told
    assert (tmp_path / "strip.png").stat().st_size > 5_000
    told = shell("tactile_graph", "run", "fingers", "-o", "strokes.csv")
    head, *rows = (tmp_path / "strokes.csv").read_text().splitlines()
    assert head.endswith("stroke.centre_error_cm,stroke.length_error_cm")
    assert len(rows) == 5
    told = shell("tactile_graph", "compare", "fingers", "--report", "fingers.html")
    assert re.search(r"length cm +fingers[ *]+0\.000", told), told
    page = (tmp_path / "fingers.html").read_text("utf-8")
    assert "<h2>How long the strokes were</h2><ul><li><b>fingers</b>: 5 strokes, 0.00 cm" in page
    assert 'class="area"' in page
    assert "7.0 cm</text>" in page
    assert time.perf_counter() - start < SLOWEST_S, shell.spent_s


def _write(folder: Path) -> None:
    """Put what an author writes in the place of what ``new`` began with."""
    for part in ("src", "tests"):
        shutil.rmtree(folder / part)
        shutil.copytree(EXAMPLE / part, folder / part)
    assert (folder / "pyproject.toml").read_text() == (EXAMPLE / "pyproject.toml").read_text()
