"""Who may import whom: the core no plugin, a plugin of the core only what third parties may use."""

from __future__ import annotations

import ast
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PUBLIC = (
    "tactile_graph",
    "tactile_graph.wires",
    "tactile_graph.steps",
    "tactile_graph.errors",
    "tactile_graph.files",
    "tactile_graph.compiled",
    "tactile_graph.plugins.hookspecs",
)
SHARED = ("tactile_graph.plugins.registry", "tactile_graph.pipeline.document")
"""Also to be had by plugins: where pads, presets and steps are looked up by name, and YAML whose
mistakes are told with their places."""


def imports(path: Path) -> Iterator[tuple[str, str]]:
    """Yield (module, name) for each import of a file; the name is empty for plain imports."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from ((a.name, "") for a in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: relative import"
            yield from ((node.module or "", a.name) for a in node.names)


def files(*folders: str) -> list[Path]:
    return sorted(p for f in folders for p in (ROOT / f).rglob("*.py"))


@pytest.mark.parametrize("path", files("tactile_graph"), ids=lambda p: str(p.relative_to(ROOT)))
def test_the_core_imports_no_plugin(path: Path) -> None:
    assert [m for m, _ in imports(path) if m.startswith("tactile_graph_")] == []


def test_the_core_names_no_plugin_and_holds_no_algorithm() -> None:
    heavy = {"skimage", "scipy", "serial", "cv2"}
    roots = {m.partition(".")[0] for p in files("tactile_graph") for m, _ in imports(p)}
    assert roots & heavy == set()


def test_a_family_imports_no_private_name_and_only_what_third_parties_may_use() -> None:
    found = []
    for path in files("plugins", "pipelines"):
        # A command is about the command line: it may use whatever the command line is made of.
        commands = "commands" in path.parts
        for module, name in imports(path):
            if module.partition(".")[0] != "tactile_graph":
                continue
            public = module in (*PUBLIC, *SHARED) or module.startswith(
                ("tactile_graph.wires.", "tactile_graph.steps.")
            )
            hidden = any(p.startswith("_") for p in (*module.split("."), name))
            if hidden or not (public or commands):
                found.append(f"{path.relative_to(ROOT)}: {module} {name}")
    assert found == []


HEAVY = ("skimage", "numba", "matplotlib", "scipy", "networkx", "pandas")


@pytest.mark.parametrize(
    "code",
    [
        "import tactile_graph",
        "from tactile_graph.plugins.registry import installed; installed()",
        "import tactile_graph; tactile_graph.Frame.of([[1.0]])",
        "import tactile_graph; tactile_graph.load",
    ],
)
def test_light_work_imports_nothing_heavy(code: str) -> None:
    check = f"{code}\nimport sys\nprint([m for m in {HEAVY!r} if m in sys.modules])"
    out = subprocess.run([sys.executable, "-c", check], capture_output=True, text=True, check=True)
    assert out.stdout.strip() == "[]"


def test_bare_hookimpl_does_not_pay_for_numpy() -> None:
    check = "from tactile_graph import hookimpl\nimport sys\nprint('numpy' in sys.modules)"
    out = subprocess.run([sys.executable, "-c", check], capture_output=True, text=True, check=True)
    assert out.stdout.strip() == "False"


def test_the_public_names_are_all_there() -> None:
    import tactile_graph

    assert dir(tactile_graph) == sorted(tactile_graph.__all__)
    assert all(getattr(tactile_graph, name) is not None for name in tactile_graph.__all__)
    with pytest.raises(AttributeError, match="module 'tactile_graph' has no attribute 'nope'"):
        tactile_graph.nope  # noqa: B018
