"""The report of a comparison: one HTML file, to look at in any browser, offline and on paper."""

from __future__ import annotations

from pathlib import Path

from tactile_graph_compare.records.comparison import Comparison


def write_report(comparison: Comparison, path: Path | str) -> None:
    """Write the report; the file is there whole or not at all.

    Parameters
    ----------
    comparison : Comparison
    path : path
        An existing file is replaced.
    """
    from tactile_graph.files import write_whole
    from tactile_graph_compare.report.page import page

    write_whole(path, page(comparison))
