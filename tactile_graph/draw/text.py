"""A pipeline's graph as text that other programs draw: mermaid and Graphviz dot."""

from __future__ import annotations

from collections.abc import Set

from tactile_graph.draw.blocks import Block, Wire, blocks, wires
from tactile_graph.pipeline.graph import Graph

_MERMAID_ARROWS = {"data": "-->", "guard": "-.->", "choice": "-.->"}
_MERMAID_CODES = {c: f"#{ord(c)};" for c in '"#&<>`\\|[]{}()'}
_DOT_STYLES = {"data": "solid", "guard": "dashed", "choice": "dotted"}


def graph_mermaid(pipeline: Graph, new: Set[str] = frozenset()) -> str:
    """Return the graph as a mermaid flowchart; ``new`` nodes get a thicker border."""
    shown = blocks(pipeline)
    ids = {b.key: f"n{i}" for i, b in enumerate(shown)}  # names may be mermaid's own words
    lines = ["flowchart LR"]
    lines += [f"    {ids[b.key]}{_mermaid_box(b)}" for b in shown]
    lines += [
        f"    {ids[w.start]} {_MERMAID_ARROWS[w.kind]}{_mermaid_label(w)} {ids[w.end]}"
        for w in wires(pipeline)
    ]
    outputs = [ids[b.key] for b in shown if b.outputs]
    thick = [ids[b.key] for b in shown if b.key in new]
    if outputs:
        lines.append("    classDef output fill:#dcf1e1,stroke:#2f8a4c,color:#16202e")
        lines.append(f"    class {','.join(outputs)} output")
    if thick:
        lines.append("    classDef new stroke-width:4px")
        lines.append(f"    class {','.join(thick)} new")
    return "\n".join(lines) + "\n"


def _mermaid_box(block: Block) -> str:
    text = "<br/>".join(_mermaid_text(line) for line in _lines(block))
    return f'(["{text}"])' if block.role in ("source", "choice") else f'["{text}"]'


def _mermaid_label(wire: Wire) -> str:
    label = _label(wire)
    return f'|"{_mermaid_text(label)}"|' if label else ""


def _mermaid_text(text: str) -> str:
    return "".join(_MERMAID_CODES.get(c, c if c.isprintable() else " ") for c in text)


def graph_dot(pipeline: Graph, new: Set[str] = frozenset()) -> str:
    """Return the graph in Graphviz' language; ``new`` nodes get a thicker border."""
    lines = [
        f"digraph {_dot_text(pipeline.name)} {{",
        "    rankdir=LR;",
        '    node [shape=box, style="rounded,filled", fillcolor="#f3f5f9", fontname="Helvetica"];',
        '    edge [fontname="Helvetica", fontsize=10];',
    ]
    lines += [f"    {_dot_text(b.key)} [{_dot_box(b, b.key in new)}];" for b in blocks(pipeline)]
    for wire in wires(pipeline):
        label = _label(wire)
        shown = f", label={_dot_text(label)}" if label else ""
        ends = f"{_dot_text(wire.start)} -> {_dot_text(wire.end)}"
        lines.append(f"    {ends} [style={_DOT_STYLES[wire.kind]}{shown}];")
    return "\n".join([*lines, "}"]) + "\n"


def _dot_box(block: Block, new: bool) -> str:
    parts = [f"label={_dot_text(*_lines(block))}"]
    if block.outputs:
        parts.append('fillcolor="#dcf1e1"')
    if block.role == "choice":
        parts.append("shape=ellipse")
    if block.each:
        parts.append("peripheries=2")
    if new:
        parts.append("penwidth=4")
    return ", ".join(parts)


def _dot_text(*lines: str) -> str:
    kept = ["".join(c if c.isprintable() else " " for c in line) for line in lines]
    quoted = [line.replace("\\", "\\\\").replace('"', '\\"') for line in kept]
    return '"' + "\\n".join(quoted) + '"'


def _lines(block: Block) -> list[str]:
    step = [block.step] if block.step not in ("", block.title) else []
    own = block.outputs == (block.title,)
    named = "" if own else " " + ", ".join(block.outputs)
    output = [f"output{named}"] if block.outputs else []
    return [t for t in (block.title, *step, *block.settings, block.guard, *output) if t]


def _label(wire: Wire) -> str:
    return f"choice {wire.label}" if wire.kind == "choice" else wire.label
