"""The merged graph: whose each node is, what is new in it, what it took."""

from __future__ import annotations

import re

from tactile_graph.draw.graph_boxes import Mark
from tactile_graph.draw.svg import graph_svg
from tactile_graph_compare.output.tables import saving, us
from tactile_graph_compare.records.comparison import Comparison
from tactile_graph_compare.records.graph import MergedNode
from tactile_graph_compare.report.badges import chip, legend, paint_of
from tactile_graph_compare.report.markup import Html, details, scroll, tag

MOST_MARKS = 8
SMALLEST = 0.85


def graph(comparison: Comparison) -> Html:
    """Return the drawing with its key, and the same as a table."""
    nodes = comparison.graph.nodes
    drawn = graph_svg(
        comparison.graph.pipeline,
        frozenset(n.name for n in nodes if n.new_in),
        notes={n.name: tuple(_notes(n)) for n in nodes},
        marks={n.name: _marks(comparison, n) for n in nodes},
    )
    told = saving(comparison)
    caption = (
        "Nodes that are equal in several variants are one, and ran once for all. A thick border "
        "marks what is new in a variant against the one it evolved from; the plates tell whose a "
        "node is; times are medians over the frames it ran in. "
        f"{told[0].upper()}{told[1:]}."
    )
    return tag(
        "div",
        legend(comparison),
        tag(
            "figure",
            scroll("merged graph", Html(drawn)),
            tag("figcaption", caption),
            class_="graph",
            style=f"--least:{_least_px(drawn)}px",
        ),
        details("The nodes as a table", _table(comparison)),
    )


def _least_px(drawn: str) -> int:
    """Return how narrow the drawing may be shrunk before its words get too small."""
    width = re.search(r'width="([\d.]+)"', drawn)
    return round(SMALLEST * float(width[1])) if width else 0


def _notes(node: MergedNode) -> list[str]:
    lines = [f"{us(node.time_us)} µs · ran {node.n_ran}" if node.n_ran else "never ran"]
    rest = (("skipped", node.n_skipped), ("failed", node.n_failed), ("not asked", node.n_not_asked))
    told = ", ".join(f"{word} {n}" for word, n in rest if n)
    return [*lines, told] if told else lines


def _marks(comparison: Comparison, node: MergedNode) -> list[Mark]:
    numbers = [v.number for v in comparison.variants if v.label in node.own_names]
    if len(comparison.variants) > 1 and len(numbers) == len(comparison.variants):
        return [Mark("all", "#3f4b5c")]
    marks = [Mark(str(n), paint_of(n)) for n in numbers[:MOST_MARKS]]
    rest = len(numbers) - len(marks)
    return [*marks, Mark(f"+{rest}", "#3f4b5c")] if rest else marks


def _table(comparison: Comparison) -> Html:
    columns = ("node", "step", "variants", "new in", "median µs", "total s", "ran", "skipped",
               "failed", "not asked")  # fmt: skip
    words = columns[:4]
    head = tag(
        "tr", (tag("th", c, scope="col", class_="words" if c in words else None) for c in columns)
    )
    numbers = {v.label: v.number for v in comparison.variants}

    def chips(labels: tuple[str, ...]) -> Html:
        return tag("td", [chip(numbers[label]) for label in labels], class_="words")

    rows = []
    for n in comparison.graph.nodes:
        counts = (n.n_ran, n.n_skipped, n.n_failed, n.n_not_asked)
        rows.append(
            tag(
                "tr",
                tag("th", n.name, scope="row", class_="words"),
                tag("td", n.what, tag("br") if n.guard else None,
                    tag("i", f"when {n.guard}") if n.guard else None, class_="words"),
                chips(n.variants),
                chips(n.new_in),
                tag("td", us(n.time_us) if n.n_ran else ""),
                tag("td", f"{n.total_s:.3g}"),
                (tag("td", str(c)) for c in counts),
            )
        )  # fmt: skip
    caption = tag("caption", tag("b", "Nodes of the merged graph"))
    made = tag("table", caption, tag("thead", head), tag("tbody", rows), class_="data")
    return scroll("nodes of the merged graph", made)
