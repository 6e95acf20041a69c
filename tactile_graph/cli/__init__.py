"""The command ``tactile-graph``."""

from typing import TYPE_CHECKING, Any

from tactile_graph.cli.entry import main

if TYPE_CHECKING:
    from tactile_graph.cli.app import cli

__all__ = ["cli", "main"]


def __getattr__(name: str) -> Any:
    """Import the group of commands when it is asked for."""
    if name == "cli":
        from tactile_graph.cli.app import cli

        return cli
    raise AttributeError(f"module 'tactile_graph.cli' has no attribute {name!r}")
