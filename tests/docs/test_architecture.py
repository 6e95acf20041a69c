"""docs/architecture.md names what is there: tree, files of each hop, what circle-3 always runs."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tactile_graph import load
from tactile_graph.engine.plan import make_plan

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "architecture.md"
BASES = ("tactile_graph", "plugins/tactile_graph_compare", "")
"""Where the files that hops name are: the core, and the family whose way is told last."""
pytestmark = pytest.mark.skipif(not PAGE.is_file(), reason="the docs are not beside the tests")


def tree() -> str:
    found = re.search(r"(?:^    .*\n)+", PAGE.read_text("utf-8"), re.M)
    assert found is not None
    return found.group()


def under(head: str, indent: str) -> set[str]:
    """Return the names the tree has below one of its lines."""
    _, _, rest = f"\n{tree()}".partition(f"\n{head} ")
    names: set[str] = set()
    for line in rest.splitlines()[1:]:
        if re.match(r"    \S", line):
            break
        if found := re.match(rf"{indent}(\S+)", line):
            names.add(found[1].rstrip("/"))
    return names


def test_the_tree_lists_every_part_of_the_core_and_nothing_else() -> None:
    there = {p.name for p in (ROOT / "tactile_graph").iterdir() if not p.name.startswith("__")}
    assert under("    tactile_graph/", "      ") == there - {"py.typed"}


def test_the_tree_lists_every_family() -> None:
    there = {p.parent.name for p in (ROOT / "plugins").glob("*/__init__.py")}
    assert under("    plugins/", "      ") == there


def test_the_other_folders_it_names_are_there() -> None:
    last = tree().splitlines()[-1].split()
    assert last == ["tests/", "benchmarks/", "docs/", "examples/"]
    assert all((ROOT / name).is_dir() for name in last)
    assert list((ROOT / "pipelines" / "tactile_graph_pipelines").glob("*.yaml"))


def test_every_file_a_hop_names_is_there() -> None:
    named = set(re.findall(r"`([a-z_/]+\.py)`", PAGE.read_text("utf-8")))
    assert len(named) > 30
    missing = [n for n in named if not any((ROOT / base / n).exists() for base in BASES)]
    assert missing == []


def test_what_circle_3_always_runs_is_as_told() -> None:
    pipeline = load("circle-3")
    plan = make_plan(pipeline, tuple(pipeline.outputs))
    main = [plan.items[slot].name for slot in plan.main if plan.items[slot].node is not None]
    assert main == ["footprint", "circle"]
    text = " ".join(PAGE.read_text("utf-8").split())
    assert "main are only `footprint` and `circle`, whose guard `touched`" in text
    classes = [
        n for n, x in pipeline.nodes.items() if x.signature and x.signature.kind.value == "class"
    ]
    steps = [pipeline.nodes[n].what for n in classes]
    assert f"these are {', '.join(f'`{s}`' for s in steps[:-1])} and `{steps[-1]}`" in text
