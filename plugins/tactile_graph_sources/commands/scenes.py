"""``tactile-graph scenes``: what can be put on a simulated pad by name."""

from __future__ import annotations

import click

from tactile_graph.cli.pages.listing import complete, list_files


@click.command(epilog="tactile-graph schema scene --keys tells every key of such a file.")
@click.argument("name", required=False, shell_complete=lambda c, p, word: complete("scenes", word))
def scenes(name: str | None) -> None:
    """List the scenes that 'simulate' can show, or print the file of NAME, to make one's own."""
    list_files("scenes", name)
