"""The whole report: one HTML page that needs nothing but itself."""

from __future__ import annotations

from tactile_graph_compare.output import tables
from tactile_graph_compare.records.comparison import Comparison
from tactile_graph_compare.report import strips, timeline
from tactile_graph_compare.report.album import Album
from tactile_graph_compare.report.badges import legend, of
from tactile_graph_compare.report.data_tables import table
from tactile_graph_compare.report.graph import graph
from tactile_graph_compare.report.headline import headline, warnings
from tactile_graph_compare.report.lineage import lineage
from tactile_graph_compare.report.markup import Html, figure, join, plots, scroll, section, tag
from tactile_graph_compare.report.provenance import provenance
from tactile_graph_compare.report.scatter import scatter
from tactile_graph_compare.report.spread import (
    agreement_spread,
    error_spread,
    intervals,
    time_spread,
)
from tactile_graph_compare.report.style import STYLE
from tactile_graph_compare.score.quantities import in_order

POLICY = "default-src 'none'; img-src data:; style-src 'unsafe-inline'"
"""What the page may load: nothing. A browser holds it to that."""


def page(comparison: Comparison) -> str:
    """Return the report as HTML."""
    album = Album(comparison)
    found = [
        ("summary", "Summary", _summary(comparison)),
        ("graph", "The merged graph", graph(comparison)),
        ("pareto", "Error against time", _pareto(comparison)),
        ("errors", "Errors", _errors(comparison)),
        ("differences", "Paired differences", _differences(comparison)),
        ("agreement", "Agreement", _agreement(comparison)),
        ("times", "Times", _times(comparison)),
        ("lineage", "Lineage", _lineage(comparison, album)),
        ("frames", "Chosen frames", _frames(comparison, album)),
        ("timeline", "What ran", _timeline(comparison, album)),
        ("making", "How it was made", provenance(comparison)),
    ]
    shown = [(name, title, body) for name, title, body in found if body]
    links = (tag("li", tag("a", title, href=f"#{name}")) for name, title, _ in shown[1:])
    title = " · ".join(comparison.labels[:4]) + (" …" if len(comparison.labels) > 4 else "")
    told = tables.heading(comparison)
    body = tag(
        "body",
        album.defined(),
        tag("header", tag("h1", "Comparison"), tag("p", f"{told}."),
            tag("nav", tag("ul", links), aria_label="sections")),
        tag("main", (section(name, title, body) for name, title, body in shown)),
    )  # fmt: skip
    head = tag(
        "head",
        tag("meta", charset="utf-8"),
        tag("meta", name="viewport", content="width=device-width, initial-scale=1"),
        tag("meta", http_equiv="Content-Security-Policy", content=POLICY),
        tag("meta", name="color-scheme", content="light dark"),
        tag("title", f"Comparison: {title}"),
        tag("style", Html(STYLE)),
    )
    return f"<!doctype html>\n{tag('html', head, body, lang='en')}\n"


def _summary(comparison: Comparison) -> Html:
    return join(list(warnings(comparison)), legend(comparison), headline(comparison))


def _pareto(comparison: Comparison) -> Html | None:
    shown = plots(*(scatter(comparison, q) for q in comparison.quantities))
    return figure(
        shown,
        "Filled: on the Pareto front, beaten in both error and time by none that answers as "
        "often; hollow: beaten. Down and left is better; shaded is what the best have beaten.",
    )


def _errors(comparison: Comparison) -> Html | None:
    rows = tables.errors(comparison)
    shown = plots(*(error_spread(comparison, q) for q in comparison.quantities))
    told = "Histograms of all answers. Dot: median; thick: the middle half; thin: the middle 90 %."
    drawn = figure(shown, told)
    return join(table(comparison, rows) if rows.rows else None, drawn) or None


def _differences(comparison: Comparison) -> Html | None:
    rows = tables.differences(comparison)
    if not rows.rows:
        return None
    drawn = figure(
        plots(*(intervals(comparison, q) for q in comparison.quantities)),
        "Dot: mean of the paired differences, left of 0 is better; bar: 95 % interval.",
    )
    return join(drawn, table(comparison, rows))


def _agreement(comparison: Comparison) -> Html | None:
    rows = tables.agreement(comparison)
    if not rows.rows:
        return None
    drawn = figure(
        plots(*(agreement_spread(comparison, q) for q in in_order(comparison.units))),
        "Histograms of all differences. Dot: median; thick: the middle half; thin: the middle "
        "90 %.",
    )
    return join(table(comparison, rows), drawn)


def _times(comparison: Comparison) -> Html:
    drawn = figure(
        plots(time_spread(comparison)),
        "Dot: median; thick: the middle half; thin: the middle 90 %.",
    )
    return tag("div", drawn, table(comparison, tables.times(comparison)), class_="beside")


def _lineage(comparison: Comparison, album: Album) -> Html | None:
    if not comparison.lineage:
        return None
    key = tag(
        "ul",
        *(
            tag("li", tag("span", class_=f"stroke {kind}"), f" {word}")
            for kind, word in (("before", "before"), ("found", "after"), ("true", "true"))
        ),
        tag("li", tag("span", class_="swatch less"), " less"),
        tag("li", tag("span", class_="swatch more"), " more than before"),
        class_="legend",
    )
    return join(key, lineage(comparison, album))


def _frames(comparison: Comparison, album: Album) -> Html | None:
    if not comparison.chosen:
        return None
    left, right, bottom, top = comparison.chosen[0].frame.image.extent_cm
    told = (
        "Some at even distances, those in which each variant is worst or farthest from another, "
        "and those it gave no answer in. Errors are signed; within a frame, colours mean the same "
        "for all variants. "
        f"A picture shows the pad from above, {right - left:.3g} cm wide and {bottom - top:.3g} cm "
        "high."
    )
    return join(tag("p", told, class_="note"), strips.key(), strips.strips(comparison, album))


def _timeline(comparison: Comparison, album: Album) -> Html:
    reasons = [
        tag("li", tag("b", state), " " if state else None, told)
        for state, told in tables.reason_lines(comparison)
    ]
    return join(
        timeline.key(),
        [
            tag(
                "figure",
                tag("figcaption", of(v)),
                scroll("what ran in each frame", timeline.timeline(comparison, v, album.shown)),
            )
            for v in comparison.variants
        ],
        tag("h3", "Outputs without a value") if reasons else None,
        tag("ul", reasons) if reasons else None,
    )
