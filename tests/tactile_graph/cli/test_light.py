"""What a command imports: nothing it does not use."""

from __future__ import annotations

import subprocess
import sys

import pytest

CODE = """
import sys
from tactile_graph.cli import main
try:
    main()
except SystemExit as error:
    code = error.code
loaded = [m for m in sys.argv[0].split() if m in sys.modules]
print(code, *loaded, file=sys.stderr)
"""
HEAVY = ("skimage", "numba", "matplotlib", "scipy.spatial", "scipy.optimize", "networkx", "serial")
CORE = ("numpy", "pydantic", "rich", "yaml")


def imported(*args: str, also: tuple[str, ...] = ()) -> list[str]:
    """Return the exit code of a command and which of the watched modules it imported."""
    watched = " ".join((*CORE, *HEAVY, *also))
    code = f"import sys; sys.argv[0] = {watched!r}\n{CODE}"
    got = subprocess.run(
        [sys.executable, "-c", code, *args], capture_output=True, text=True, check=False
    )
    return got.stderr.splitlines()[-1].split()


@pytest.mark.parametrize("args", [["--help"], ["run", "--help"], ["live", "-h"], ["--version"]])
def test_help_imports_neither_numpy_nor_anything_else_that_is_slow(args):
    assert imported(*args, also=("tactile_graph.compiled", "starlette", "uvicorn")) == ["0"]


@pytest.mark.slow
@pytest.mark.parametrize("command", ["steps", "plugins"])
def test_lists_import_no_step(command):
    assert imported(command) == ["0", "rich"]


def test_listing_pipelines_imports_no_step():
    assert imported("pipelines") == ["0", "rich", "yaml"]


@pytest.mark.parametrize(
    "args", [["run", "circle-3"], pytest.param(["explain", "circle-3"], marks=pytest.mark.slow)]
)
def test_a_circle_run_imports_no_library_that_it_does_not_use(args):
    assert imported(*args) == ["0", *CORE]
