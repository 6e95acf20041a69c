"""The catalogue of steps: pages of docstrings, signatures and pictures, a page a family."""

from __future__ import annotations

import importlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from making.demonstrations import Demonstration, Shown, demonstration, shipped, shown
from making.markdown import code, fence, prose, table, toctree, write
from tactile_graph.cli.pages.step_page import in_yaml, made_up_use, ranges
from tactile_graph.docstring import parameters, sections
from tactile_graph.inspect import public_fields
from tactile_graph.plugins.registry import Registry
from tactile_graph.steps.signature import Kind, Signature, type_name

WORDS = {
    "classifiers": "Classifiers: which known object it is",
    "filters": "Filters: readings, masks, contacts",
    "fitters": "Fitters: shapes put to points and cells",
    "hull": "Hull: boundaries, gradients, convex hulls",
    "likelihood": "Likelihood: shapes by the physics of the pad",
    "mrf": "MRF: images restored by their energy",
    "sources": "Sources: where frames come from",
    "thesis": "Thesis: noise for its studies",
    "tracking": "Tracking: objects from frame to frame",
}
MEASURED = (
    "Costs are medians measured on the machine that built these pages, compiled kernels, one "
    "thread, on frames of 16 × 16 cells unless a page says otherwise."
)


@dataclass(frozen=True)
class Entry:
    """A step as the catalogue has it."""

    signature: Signature
    family: str
    found: Demonstration | str
    seen: Shown | None

    @property
    def name(self) -> str:
        """The step's."""
        return self.signature.name

    @property
    def cost(self) -> str:
        """In words."""
        return f"{_short(self.seen.cost_us)} µs" if self.seen and self.seen.cost_us else ""


def _short(value: float) -> str:
    return f"{value:,.0f}" if value >= 10 else f"{value:.1f}"


def entries(registry: Registry, kept: Path) -> list[Entry]:
    """Return every step, with its picture and cost."""
    made = []
    for name in registry.names("steps"):
        found = demonstration(registry, name)
        seen = None if isinstance(found, str) else shown(found, kept)
        family = registry.offer("steps", name).plugin.name
        made.append(Entry(registry.step(name), family, found, seen))
    return made


def write_steps(registry: Registry, into: Path, kept: Path) -> int:
    """Write the pages of all steps into a folder, and return how many there are."""
    made = entries(registry, kept)
    uses = _uses(registry)
    families = sorted({e.family for e in made})
    for entry in made:
        folder = into / entry.family
        if entry.seen is not None:
            write(folder / f"{entry.name}-shown.svg", entry.seen.svg)
        write(folder / f"{entry.name}.md", "\n".join(_page(entry, uses.get(entry.name, []))))
    for family in families:
        write(into / family / "index.md", _family(family, [e for e in made if e.family == family]))
    write(into / "index.md", _index(made, families))
    return len(made)


def _uses(registry: Registry) -> dict[str, list[str]]:
    """Return the pipelines in which each step stands."""
    uses: dict[str, list[str]] = {}
    for name, pipeline in shipped(registry).items():
        steps = {n.signature.name for n in pipeline.nodes.values() if n.signature is not None}
        steps |= {pipeline.source.signature.name} if pipeline.source else set()
        for step in sorted(steps):
            uses.setdefault(step, []).append(name)
    return uses


# -- a step ----------------------------------------------------------------------------------


def _page(entry: Entry, uses: list[str]) -> Iterator[str]:
    signature = entry.signature
    doc, meanings = sections(signature.doc), parameters(signature.doc)
    yield f"# {entry.name}\n"
    yield prose(doc[""]) + "\n"
    yield _picture(entry)
    yield "## Takes and gives\n"
    ports = [
        (f"takes `{p.name}`", code(type_name(p.type)), _notes(p), prose(meanings.get(p.name, "")))
        for p in signature.ports
    ]
    yield table(("", "type", "", "meaning"), [*ports, *_outputs(signature)])
    if signature.settings:
        yield "## Settings\n"
        yield table(("setting", "type", "default", "allowed", "meaning"), _settings(signature))
    for title in ("Notes", "Raises"):
        if title in doc:
            told = _listed(doc[title]) if title == "Raises" else prose(doc[title])
            yield f"## {title}\n\n{told}\n"
    yield f"## In a pipeline\n\n{_use(entry)}"
    if uses:
        links = ", ".join(f"[{name}](../../pipelines/{name}.md)" for name in uses)
        yield f"It stands in the shipped pipelines {links}.\n"


def _picture(entry: Entry) -> str:
    if entry.seen is None:
        return f"**No picture.** {entry.found}\n"
    assert isinstance(entry.found, Demonstration)
    seen, found = entry.seen, entry.found
    link = f"[{found.pipeline.name}](../../pipelines/{found.pipeline.name}.md)"
    where = f"node `{found.node}` of {link}" if found.shipped else "the pipeline below"
    alt = f"One frame before and after {entry.name}"
    grid = f"{seen.rows} × {seen.columns} cells"
    note = f" {seen.note}" if seen.note else ""
    head = f"```{{figure}} {entry.name}-shown.svg\n:alt: {alt}\n:figclass: wide\n\n"
    if not entry.cost:
        return f"{head}What it gives: frame {seen.frame}, {where}.\n```\n"
    return (
        f"{head}What it reads, left, and what it gives, right: frame {seen.frame}, {where}.{note}"
        f"\n```\n\n**Cost**: {entry.cost} for a frame of {grid}, "
        "measured [where this page was built](../index.md#what-each-costs).\n"
    )


def _notes(port: Any) -> str:
    notes = [] if port.required else ["optional"]
    if port.quantity is not None:
        notes.append(" or ".join(port.quantity.names) or f"quantity of {port.quantity.port}")
    return ", ".join(notes)


def _outputs(signature: Signature) -> list[tuple[str, str, str, str]]:
    state = "it remembers from frame to frame" if signature.stateful else ""
    if signature.kind is Kind.SOURCE:
        return [("gives", "`Frame`", "one after the other", "")]
    rows = [("gives", code(type_name(signature.output)), state, "")]
    types = public_fields(signature.output)
    names = signature.fields or tuple(getattr(signature.output, "columns_shown", ()))
    return rows + [(f"gives `.{n}`", code(type_name(types.get(n, Any))), "", "") for n in names]


def _settings(signature: Signature) -> Iterator[tuple[str, ...]]:
    meanings = parameters(signature.doc)
    for s in signature.settings:
        default = "required" if s.required else code(in_yaml(s.default))
        meaning = prose(meanings.get(s.name, s.meaning))
        allowed = ", ".join(ranges(s.annotation))
        yield code(s.name), code(type_name(s.annotation)), default, allowed, meaning


def _listed(text: str) -> str:
    """Return the errors of a docstring as a list."""
    told: list[list[str]] = []
    for line in text.splitlines():
        if line and not line[0].isspace():
            told.append([line.strip(), ""])
        elif told:
            told[-1][1] += f" {line.strip()}"
    return "\n".join(f"- `{name}`: {prose(words.strip())}" for name, words in told)


def _use(entry: Entry) -> str:
    found = entry.found
    if isinstance(found, str):
        return fence("yaml", made_up_use(entry.signature))
    if found.shipped:
        from making.pipeline_pages import node_text

        name = found.pipeline.name
        head = f"As [{name}](../../pipelines/{name}.md) has it:\n\n"
        return head + fence("yaml", node_text(found.pipeline, found.node))
    return "The pipeline of the picture:\n\n" + fence("yaml", found.pipeline.text)


# -- families --------------------------------------------------------------------------------


def _family(family: str, members: list[Entry]) -> str:
    package = importlib.import_module(f"tactile_graph_{family}")
    rows = [
        (f"[{e.name}]({e.name}.md)", e.cost, prose(e.signature.summary.removeprefix("Return ")))
        for e in members
    ]
    about = prose((package.__doc__ or "").strip())
    parts = [f"# {WORDS.get(family, family.capitalize())}\n", f"{about}\n"]
    parts.append(table(("step", "cost", "what comes out"), rows))
    parts.append(f"{MEASURED}\n")
    parts.append(toctree([e.name for e in members], hidden=True))
    return "\n".join(parts)


def _index(made: list[Entry], families: list[str]) -> str:
    rows = []
    for family in families:
        members = [e for e in made if e.family == family]
        names = ", ".join(f"[{e.name}]({family}/{e.name}.md)" for e in members)
        rows.append((f"[{WORDS.get(family, family)}]({family}/index.md)", names))
    dear = sorted((e for e in made if e.seen), key=lambda e: -(e.seen.cost_us if e.seen else 0.0))
    costs = [
        (f"[{e.name}]({e.family}/{e.name}.md)", e.cost, f"{e.seen.rows} × {e.seen.columns}")
        for e in dear
        if e.seen is not None and e.cost
    ]
    parts = [f"# All {len(made)} steps\n", table(("family", "steps"), rows)]
    parts.append(f"## What each costs\n\n{MEASURED} Dearest first.\n")
    parts.append(table(("step", "cost", "cells"), costs))
    parts.append(toctree([f"{f}/index" for f in families], hidden=True))
    return "\n".join(parts)
