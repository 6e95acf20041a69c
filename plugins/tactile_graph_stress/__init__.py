"""Numerical stability of whatever steps are installed: the command ``tactile-graph stress``."""

from collections.abc import Mapping

from tactile_graph import hookimpl
from tactile_graph_stress import hookspecs as hookspecs


@hookimpl
def tactile_graph_commands() -> Mapping[str, str]:
    """Offer the command that stresses steps."""
    return {"stress": "tactile_graph_stress.commands.stress:stress"}


@hookimpl
def tactile_graph_stress_cases() -> Mapping[str, str]:
    """Offer what steps are stressed with that take points, masks, images or readings."""
    homes = ("points", "masks", "images", "circuits")
    return {name: f"{__name__}.cases.{name}:{name.upper()}" for name in homes}
