"""``ReportSection``: one part of the report, and what makes it."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from tactile_graph_compare.records.comparison import Comparison
from tactile_graph_compare.report.album import Album
from tactile_graph_compare.report.markup import Html


class ReportSection(NamedTuple):
    """One part of the report.

    Attributes
    ----------
    title : str
        Its heading.
    body : callable
        Returns what stands below it, made with `tactile_graph_compare.report.markup`, of a
        comparison and the album of its pictures; None where there is nothing to tell.
    last : bool
        Whether it stands behind those of all plugins.
    """

    title: str
    body: Callable[[Comparison, Album], Html | None]
    last: bool = False
