"""``tactile-graph pads``: the pads that plugins describe."""

from __future__ import annotations

import click

from tactile_graph.cli.pages.listing import complete, list_files


@click.command(epilog="tactile-graph schema pad --keys tells every key of such a file.")
@click.argument("name", required=False, shell_complete=lambda c, p, word: complete("pads", word))
def pads(name: str | None) -> None:
    """List the pads, or print the file of NAME, from which one's own can be made."""
    list_files("pads", name)
