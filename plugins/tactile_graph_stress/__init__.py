"""Numerical stability of whatever steps are installed: the command ``tactile-graph stress``."""

from collections.abc import Mapping

from tactile_graph import hookimpl


@hookimpl
def tactile_graph_commands() -> Mapping[str, str]:
    """Offer the command that stresses steps."""
    return {"stress": "tactile_graph_stress.commands.stress:stress"}
