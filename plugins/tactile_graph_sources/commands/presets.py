"""``tactile-graph presets``: the kits on a serial port that can be read by name."""

from __future__ import annotations

import click

from tactile_graph.cli.pages.listing import complete, list_files


@click.command(epilog="tactile-graph schema preset --keys tells every key of such a file.")
@click.argument("name", required=False, shell_complete=lambda c, p, word: complete("presets", word))
def presets(name: str | None) -> None:
    """List the presets of serial devices, or print the file of NAME, to make one's own from it."""
    list_files("presets", name)
