"""The sources family."""

from collections.abc import Mapping

from tactile_graph import hookimpl


@hookimpl
def tactile_graph_steps() -> Mapping[str, str]:
    """Offer the sources."""
    return {}
