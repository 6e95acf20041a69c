"""The hooks of comparisons: what else their reports tell."""

from __future__ import annotations

from collections.abc import Mapping

from tactile_graph.plugins.hookspecs import hook_of


@hook_of("tactile_graph_compare.report.report_section:ReportSection")
def tactile_graph_report_sections() -> Mapping[str, str]:  # type: ignore[empty-body]
    """Section of ``compare --report`` -> import string of its `ReportSection`."""
