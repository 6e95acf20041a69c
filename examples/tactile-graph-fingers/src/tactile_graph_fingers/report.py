"""A section of comparisons' reports: how far off the lengths of strokes are."""

from tactile_graph_compare import Comparison
from tactile_graph_compare.report.album import Album
from tactile_graph_compare.report.markup import Html, join, tag
from tactile_graph_compare.report.report_section import ReportSection


def lengths(comparison: Comparison, album: Album) -> Html | None:
    """Return a line for each variant whose strokes have true lengths; None without any."""
    found = [score for score in comparison.scores if score.quantity == "length"]
    lines = [
        tag("li", tag("b", s.variant), f": {s.n_answered} strokes, {s.mean or 0.0:.2f} cm off")
        for s in found
    ]
    return join(tag("ul", lines)) if lines else None


STROKES = ReportSection("How long the strokes were", lengths)
