"""``tactile-graph steps``: a list of all, made without importing them, or one in full."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from tactile_graph.errors import UsageError
from tactile_graph.plugins import registry

if TYPE_CHECKING:
    from rich.console import RenderableType


def complete_step(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
    """Return the steps whose names begin so, for the shell."""
    return [n for n in registry.installed().names("steps") if n.startswith(incomplete)]


@click.command()
@click.argument("name", required=False, shell_complete=complete_step)
def steps(name: str | None) -> None:
    """List the steps by plugin, or describe NAME: ports, settings with ranges, outputs, use."""
    from tactile_graph.cli.terminal import console

    found = registry.installed()
    if name is None:
        console().print(_list(found))
        return
    if not found.has("steps", name):
        raise UsageError(found.unknown("steps", name))
    from tactile_graph.cli.step_page import step_page

    out = console()
    for part in step_page(found, name):
        out.print(part)


def _list(found: registry.Registry) -> RenderableType:
    from rich import box
    from rich.table import Table
    from rich.text import Text

    from tactile_graph.plugins.outline import outline

    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    table.add_column("step", no_wrap=True)
    table.add_column("takes → gives", overflow="fold")
    table.add_column("what")
    for plugin in sorted(found.plugins, key=lambda p: p.name):
        names = sorted(plugin.offers.get("steps", {}))
        if names:
            table.add_row(Text(plugin.name, style="bold cyan"), "", "")
        for i, name in enumerate(names):
            step = outline(plugin.offers["steps"][name])
            what = Text(step.trouble, style="red") if step.trouble else Text(_what(step.summary))
            table.add_row(Text(f"  {name}", style="bold"), Text(step.wiring, style="dim"), what,
                          end_section=i == len(names) - 1)  # fmt: skip
    return table


def _what(summary: str) -> str:
    text = summary.replace("`", "").removeprefix("Return ").removesuffix(".")
    return text[:1].upper() + text[1:]
