"""Convex hulls of points, by several algorithms that give the same corners."""

from collections.abc import Mapping

from tactile_graph import hookimpl


@hookimpl
def tactile_graph_steps() -> Mapping[str, str]:
    """Offer the hull steps."""
    return {}
