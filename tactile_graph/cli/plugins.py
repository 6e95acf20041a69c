"""``tactile-graph plugins``: what is installed, what it offers, what is wrong with it."""

from __future__ import annotations

from typing import Any

import click

from tactile_graph.plugins import registry
from tactile_graph.plugins.mistakes import near_groups

NARROW = 80
"""Columns of a terminal below which what is offered goes before how long it took to import."""


@click.command()
def plugins() -> None:
    """List the plugins: package, version, import time, what they offer, what is wrong."""
    from rich import box
    from rich.table import Table
    from rich.text import Text

    from tactile_graph.cli.terminal import console

    found = registry.installed()
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    table.add_column("plugin", style="bold", no_wrap=True)
    table.add_column("package", no_wrap=True)
    table.add_column("version", no_wrap=True)
    out = console()
    timed = out.width >= NARROW
    if timed:
        table.add_column("import ms", justify="right")
    table.add_column("offers", overflow="fold")
    for plugin in found.plugins:
        spent = ["" if plugin.blocked else f"{plugin.import_ms:.1f}"] if timed else []
        table.add_row(plugin.name, plugin.package, plugin.version, *spent, _offers(plugin))
    out.print(table)
    for plugin in found.plugins:
        if plugin.error:
            text = Text.assemble((f"{plugin.label}: ", "bold red"), plugin.error)
            out.print(text, soft_wrap=True)
    from tactile_graph.cli.app import COMMANDS

    for words in near_groups(registry.GROUP):
        out.print(Text.assemble(("not found: ", "bold red"), words), soft_wrap=True)
    hidden = [n for n in found.names("commands") if n in COMMANDS]
    for clash in [*found.clashes, *(_hidden(found, n) for n in hidden)]:
        out.print(Text.assemble(("clash: ", "bold red"), clash), soft_wrap=True)


def _hidden(found: registry.Registry, name: str) -> str:
    label = found.offer("commands", name).plugin.label
    return f"command {name!r} of {label} is refused: tactile-graph has its own"


def _offers(plugin: registry.Plugin) -> Any:
    from rich.text import Text

    if plugin.blocked:
        return Text("blocked", style="yellow")
    if plugin.error:
        return Text("failed to load, see below", style="red")
    parts = [
        f"{len(names)} {kind if len(names) != 1 else kind[:-1]}"
        for kind, names in plugin.offers.items()
        if names
    ]
    return Text(", ".join(parts) or "nothing", style="" if parts else "dim")
