"""Pads: their physics (coverage, force law, circuits) and the YAML files that describe them."""

from collections.abc import Mapping

from tactile_graph import hookimpl


@hookimpl
def tactile_graph_steps() -> Mapping[str, str]:
    """Offer the pads' steps."""
    return {}
