"""The command ``tactile-graph``."""

from tactile_graph.cli.app import cli, main

__all__ = ["cli", "main"]
