"""Who may import whom: the core no plugin, a plugin of the core only what third parties may use."""

from __future__ import annotations

import ast
import subprocess
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import networkx as nx
import pytest

ROOT = Path(__file__).parents[2]
PUBLIC = (
    "tactile_graph",
    "tactile_graph.code_version",
    "tactile_graph.wires",
    "tactile_graph.steps",
    "tactile_graph.docstring",
    "tactile_graph.errors",
    "tactile_graph.exporter",
    "tactile_graph.files",
    "tactile_graph.foreign_text",
    "tactile_graph.live",
    "tactile_graph.locks",
    "tactile_graph.many",
    "tactile_graph.out_of_reach",
    "tactile_graph.compiled",
    "tactile_graph.plugins.hookspecs",
    "tactile_graph.plugins.file_check",
    "tactile_graph.plugins.file_kind",
    "tactile_graph.inspect",
    "tactile_graph.provenance",
    "tactile_graph.quantities",
    "tactile_graph.text_files",
    "tactile_graph.vocabulary",
)
"""What third parties may use: of steps, of whatever looks into pipelines and their outcomes and
says how it was made, as comparisons do, and the words that plugins offer."""
PUBLIC_ROOMS = ("tactile_graph.wires.", "tactile_graph.steps.", "tactile_graph.draw.")
"""Rooms whose every module is public: values, steps, and how both are drawn for people."""
SHARED = ("tactile_graph.plugins.registry", "tactile_graph.pipeline.document")
"""Also to be had by plugins: where pads, presets and steps are looked up by name, and YAML whose
mistakes are told with their places."""


def statements(within: ast.AST) -> Iterator[ast.AST]:
    """Yield what is no expression: most of a file is, and no import stands in one."""
    for node in ast.iter_child_nodes(within):
        if not isinstance(node, ast.expr):
            yield node
            yield from statements(node)


@cache
def imports(path: Path) -> list[tuple[str, str]]:
    """Return (module, name) for each import of a file; the name is empty for plain imports."""
    found = []
    for node in statements(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found += [(a.name, "") for a in node.names]
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: relative import"
            found += [(node.module or "", a.name) for a in node.names]
    return found


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
            public = module in (*PUBLIC, *SHARED) or module.startswith(PUBLIC_ROOMS)
            hidden = any(p.startswith("_") for p in (*module.split("."), name))
            if hidden or not (public or commands):
                found.append(f"{path.relative_to(ROOT)}: {module} {name}")
    assert found == []


def test_no_class_of_click_is_subscripted() -> None:
    """They are generic from 8.4 on, and 8.3 is allowed; that shows when a module is run."""
    found = [
        f"{path.relative_to(ROOT)}: {ast.unparse(base)}"
        for path in files("tactile_graph", "plugins", "pipelines")
        for node in statements(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.ClassDef)
        for base in node.bases
        if isinstance(base, ast.Subscript) and ast.unparse(base).startswith("click.")
    ]
    assert found == []


# -- circles ---------------------------------------------------------------------------------


def modules() -> dict[str, Path]:
    """Return every module of the core and of the families by name."""
    found = {}
    for root in (ROOT, ROOT / "plugins", ROOT / "pipelines"):
        for package in sorted(root.glob("tactile_graph*")):
            for path in package.rglob("*.py"):
                parts = path.relative_to(root).with_suffix("").parts
                found[".".join(p for p in parts if p != "__init__")] = path
    return found


@cache
def import_graph() -> nx.DiGraph[str]:
    """Return which module imports which, lazily or for a type checker only being no excuse."""
    known = modules()
    graph: nx.DiGraph[str] = nx.DiGraph()
    graph.add_nodes_from(known)
    for importer, path in known.items():
        for module, name in imports(path):
            imported = f"{module}.{name}" if f"{module}.{name}" in known else module
            if imported in known and imported != importer:
                graph.add_edge(importer, imported)
    return graph


def circles(graph: nx.DiGraph[str]) -> list[list[str]]:
    """Return the modules that import one another in a circle, a list for each circle."""
    return [sorted(c) for c in nx.strongly_connected_components(graph) if len(c) > 1]


def family(module: str) -> str:
    return module.partition(".")[0]


def room(module: str, within: str = "tactile_graph") -> str:
    """Return the room of a package (the core) a module stands in, or the module itself."""
    return ".".join(module.split(".")[: within.count(".") + 2])


FAMILIES = sorted({family(m) for m in modules()})


@pytest.mark.parametrize("package", FAMILIES)
def test_no_files_import_each_other_in_a_circle(package: str) -> None:
    graph = import_graph()
    assert circles(graph.subgraph([m for m in graph if family(m) == package])) == []


def test_no_families_import_each_other_in_a_circle() -> None:
    between = nx.DiGraph((family(a), family(b)) for a, b in import_graph().edges)
    assert circles(between) == []


def test_no_rooms_of_the_core_import_each_other_in_a_circle() -> None:
    core = [(a, b) for a, b in import_graph().edges if family(a) == family(b) == "tactile_graph"]
    assert circles(nx.DiGraph((room(a), room(b)) for a, b in core)) == []


@pytest.mark.parametrize(
    "package", ["tactile_graph.engine", "tactile_graph.pipeline", "tactile_graph_sources.readers"]
)
def test_no_rooms_within_a_large_room_import_each_other_in_a_circle(package: str) -> None:
    inside = import_graph().subgraph([m for m in modules() if m.startswith(f"{package}.")])
    between = nx.DiGraph((room(a, package), room(b, package)) for a, b in inside.edges)
    assert len(between) > 8
    assert circles(between) == []


def test_a_circle_is_found_and_named() -> None:
    assert circles(nx.DiGraph([("a", "b"), ("b", "c"), ("c", "a"), ("c", "d")])) == [
        ["a", "b", "c"]
    ]


# -- what light work loads -------------------------------------------------------------------

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
