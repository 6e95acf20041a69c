"""The thesis family: its tables and figures made again, beside the thesis' own numbers."""

from collections.abc import Mapping

from tactile_graph import hookimpl

_STEPS = ("add_noise", "flip_cells", "jitter_points")


@hookimpl
def tactile_graph_steps() -> Mapping[str, str]:
    """Offer the steps that bring known noise between the blocks of a pipeline."""
    return {name: f"{__name__}.{name}:{name}" for name in _STEPS}


@hookimpl
def tactile_graph_commands() -> Mapping[str, str]:
    """Offer the commands that make the tables and figures, and the studies of chapter 2."""
    return {name: f"{__name__}.commands.{name}:{name}" for name in ("reproduce", "study")}
