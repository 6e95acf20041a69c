"""The catalogue of pipelines: graph, one frame node by node, what it answers, its file."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

from making.demonstrations import Shown, shipped, strip_of
from making.markdown import code, facts, fence, prose, table, toctree, wide, write
from tactile_graph import Pipeline
from tactile_graph.errors import TactileGraphError
from tactile_graph.inspect import public_fields
from tactile_graph.pipeline.document import read_document
from tactile_graph.plugins.registry import Registry
from tactile_graph.steps.signature import type_name

NEEDS_OBJECTS = (
    "It names known objects, and where this page was built none was learned: "
    "see [identify](../../how-to/identify.md)."
)


def write_pipelines(registry: Registry, into: Path, kept: Path) -> int:
    """Write the pages of all pipelines into a folder, and return how many there are."""
    found = shipped(registry)
    grown: dict[str, list[str]] = {}
    for name, pipeline in found.items():
        grown.setdefault(pipeline.evolves, []).append(name)
    costs: dict[str, str] = {}
    for name, pipeline in found.items():
        seen = _seen(pipeline, kept)
        folder = into / "pipelines"
        write(folder / f"{name}-graph.svg", pipeline.svg())
        if isinstance(seen, Shown):
            write(folder / f"{name}-frame.svg", seen.svg)
            costs[name] = f"{seen.cost_us:,.0f} µs"
        page = _page(registry, pipeline, grown.get(name, []), seen)
        write(folder / f"{name}.md", "\n".join(page))
    write(into / "pipelines" / "index.md", _index(found, grown, costs))
    return len(found)


def _seen(pipeline: Pipeline, kept: Path) -> Shown | str:
    """Return picture and cost, or why there is none."""
    if any("database" in node.settings for node in pipeline.nodes.values()):
        return NEEDS_OBJECTS
    return strip_of(pipeline, kept)


def _page(
    registry: Registry, pipeline: Pipeline, grown: list[str], seen: Shown | str
) -> Iterator[str]:
    name = pipeline.name
    yield f"# {name}\n\n{prose(pipeline.about)}.\n"
    yield facts(_facts(registry, pipeline, grown, seen))
    yield "## Graph\n"
    yield wide(f"{name}-graph.svg", f"The graph of {name}")
    yield "## One frame, node by node\n"
    if isinstance(seen, str):
        yield f"**No picture.** {seen}\n"
    else:
        yield wide(f"{name}-frame.svg", f"A frame through {name}, node by node")
    yield "## Run it\n"
    yield fence("sh", f"tactile-graph run {name}\ntactile-graph run {name} recording.csv")
    yield f"## Its file\n\n{fence('yaml', pipeline.text)}"


def _facts(
    registry: Registry, pipeline: Pipeline, grown: list[str], seen: Shown | str
) -> Iterator[tuple[str, str]]:
    answers = []
    for output, ref in pipeline.outputs.items():
        kind = pipeline.nodes[ref.node].output if ref.node in pipeline.nodes else None
        for part in ref.path:
            kind = public_fields(kind).get(part)
        answers.append(f"`{output}`" + (f": {code(type_name(kind))}" if kind is not None else ""))
    yield "answers", ", ".join(answers)
    if pipeline.evolves:
        yield "evolves from", f"[{pipeline.evolves}]({pipeline.evolves}.md)"
    if grown:
        yield "leads to", ", ".join(f"[{n}]({n}.md)" for n in sorted(grown))
    if pipeline.source is not None:
        step = pipeline.source.signature.name
        yield "frames, unless told otherwise", f"[{step}](../steps/sources/{step}.md)"
    yield "steps", ", ".join(_steps(registry, pipeline))
    if isinstance(seen, Shown):
        where = f"for a frame of {seen.rows} × {seen.columns} cells"
        yield "cost", f"{seen.cost_us:,.0f} µs {where}, measured where this page was built"


def _steps(registry: Registry, pipeline: Pipeline) -> list[str]:
    names = [n.signature.name for n in pipeline.nodes.values() if n.signature is not None]
    return [
        f"[{n}](../steps/{registry.offer('steps', n).plugin.name}/{n}.md)"
        for n in dict.fromkeys(names)
    ]


def _index(
    found: Mapping[str, Pipeline], grown: Mapping[str, list[str]], costs: Mapping[str, str]
) -> str:
    rows: list[tuple[str, str, str]] = []

    def add(name: str, depth: int) -> None:
        shift = "\u2003" * depth + ("└ " if depth else "")
        rows.append((f"{shift}[{name}]({name}.md)", costs.get(name, ""), prose(found[name].about)))
        for child in sorted(grown.get(name, [])):
            add(child, depth + 1)

    for name, pipeline in found.items():
        if pipeline.evolves not in found:
            add(name, 0)
    head = (
        f"# All {len(found)} pipelines\n\nEach stands below the one it evolves from. The cost is "
        "the median time of all its nodes for a frame of its own source, on the machine that built "
        "these pages.\n"
    )
    return "\n".join(
        [head, table(("pipeline", "cost", "about"), rows), toctree(found, hidden=True)]
    )


def node_text(pipeline: Pipeline, node: str) -> str:
    """Return the lines of a pipeline's file in which a node stands, as a file would hold them.

    Raises
    ------
    TactileGraphError
        If the file has no such node.
    """
    document = read_document(pipeline.text, pipeline.name)
    names = list(document.data["nodes"])
    if node not in names:
        raise TactileGraphError(f"{pipeline.name} has no node {node!r}")
    lines = pipeline.text.splitlines()
    first = document.mark("nodes", node, key=True).line
    after = [document.mark("nodes", n, key=True).line for n in names[names.index(node) + 1 :]]
    end = (after[0] if after else document.mark("outputs", key=True).line) - 1
    kept = lines[first - 1 : end]
    while kept and (not kept[-1].strip() or kept[-1].lstrip().startswith("#")):
        kept.pop()
    return "\n".join(["nodes:", *kept])
