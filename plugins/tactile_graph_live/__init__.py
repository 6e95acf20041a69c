"""A running pad looked at in the browser: the command ``live``."""

from collections.abc import Mapping

from tactile_graph import hookimpl


@hookimpl
def tactile_graph_commands() -> Mapping[str, str]:
    """Offer the command that shows a running pad."""
    return {"live": f"{__name__}.commands.live:live"}
