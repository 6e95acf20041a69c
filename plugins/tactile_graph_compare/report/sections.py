"""The sections of the report that comparisons have themselves."""

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
from tactile_graph_compare.report.markup import Html, figure, join, plots, scroll, tag
from tactile_graph_compare.report.provenance import provenance
from tactile_graph_compare.report.report_section import ReportSection
from tactile_graph_compare.report.scatter import scatter
from tactile_graph_compare.report.spread import (
    agreement_spread,
    error_spread,
    intervals,
    time_spread,
)
from tactile_graph_compare.score.quantities import in_order


def _summary(comparison: Comparison, album: Album) -> Html:
    return join(list(warnings(comparison)), legend(comparison), headline(comparison))


def _pareto(comparison: Comparison, album: Album) -> Html | None:
    shown = plots(*(scatter(comparison, q) for q in comparison.quantities))
    return figure(
        shown,
        "Filled: on the Pareto front, beaten in both error and time by none that answers as "
        "often; hollow: beaten. Down and left is better; shaded is what those that answer most "
        "often have beaten.",
    )


def _errors(comparison: Comparison, album: Album) -> Html | None:
    rows = tables.errors(comparison)
    shown = plots(*(error_spread(comparison, q) for q in comparison.quantities))
    told = "Histograms of all answers. Dot: median; thick: the middle half; thin: the middle 90 %."
    drawn = figure(shown, told)
    return join(table(comparison, rows) if rows.rows else None, drawn) or None


def _differences(comparison: Comparison, album: Album) -> Html | None:
    rows = tables.differences(comparison)
    if not rows.rows:
        return None
    drawn = figure(
        plots(*(intervals(comparison, q) for q in comparison.quantities)),
        "Dot: mean of the paired differences, left of 0 is better; bar: 95 % interval.",
    )
    return join(drawn, table(comparison, rows))


def _agreement(comparison: Comparison, album: Album) -> Html | None:
    rows = tables.agreement(comparison)
    if not rows.rows:
        return None
    drawn = figure(
        plots(*(agreement_spread(comparison, q) for q in in_order(comparison.units))),
        "Histograms of all differences. Dot: median; thick: the middle half; thin: the middle "
        "90 %.",
    )
    return join(table(comparison, rows), drawn)


def _times(comparison: Comparison, album: Album) -> Html:
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


SUMMARY = ReportSection("Summary", _summary)
GRAPH = ReportSection("The merged graph", lambda told, album: graph(told))
PARETO = ReportSection("Error against time", _pareto)
ERRORS = ReportSection("Errors", _errors)
DIFFERENCES = ReportSection("Paired differences", _differences)
AGREEMENT = ReportSection("Agreement", _agreement)
TIMES = ReportSection("Times", _times)
LINEAGE = ReportSection("Lineage", _lineage)
FRAMES = ReportSection("Chosen frames", _frames)
TIMELINE = ReportSection("What ran", _timeline)
MAKING = ReportSection("How it was made", lambda told, album: provenance(told), last=True)
