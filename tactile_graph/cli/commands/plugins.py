"""``tactile-graph plugins``: what is installed, what it offers, what is wrong with it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import click

from tactile_graph.cli.endings import NOT_DONE
from tactile_graph.errors import TactileGraphError, UsageError
from tactile_graph.plugins import registry
from tactile_graph.plugins.mistakes import near_groups
from tactile_graph.plugins.names import OWN, Plugin, singular

EVERY = "-"
"""Stands for no name."""
NARROW = 80
"""Columns of a terminal below which what is offered goes before how long it took to import."""


@click.command(epilog="Exit codes of --check: 0 all is right, 2 something is not.")
@click.option(
    "--check", "checked", metavar="[NAME]", is_flag=False, flag_value=EVERY, default=None,
    help="Import all that a plugin offers, try its steps on some thirty frames from ordinary to "
    "absurd, and tell what is wrong, a line each. More names may follow; without one, of every "
    "plugin of others.",
)  # fmt: skip
@click.argument("more", metavar="[NAME]...", nargs=-1)
def plugins(checked: str | None, more: tuple[str, ...]) -> None:
    """List the plugins: package, version, import time, what they offer, what is wrong."""
    if checked is not None:
        from tactile_graph.cli.plugin_check import show_checked

        names = [name for name in (checked, *more) if name != EVERY]
        if not show_checked(registry.installed(), names):
            click.get_current_context().exit(NOT_DONE)
        return
    if more:
        raise UsageError(f"{more[0]}: names are for --check: tactile-graph plugins --check NAME")
    _list()


def _list() -> None:
    from rich import box
    from rich.table import Table
    from rich.text import Text

    from tactile_graph.cli.plugin_check import hidden_commands
    from tactile_graph.cli.terminal import console

    found = registry.installed()
    broken = _broken_steps(found)
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
        offers = _offers(found, plugin, broken)
        table.add_row(plugin.name, plugin.package, plugin.version, *spent, offers)
    out.print(table)
    for plugin in found.plugins:
        if plugin.error:
            text = Text.assemble((f"{plugin.label}: ", "bold red"), plugin.error)
            out.print(text, soft_wrap=True)
    for name, trouble in broken.items():
        label = found.offer("steps", name).plugin.label
        told = Text.assemble((f"{label}, step {name!r}: ", "bold red"), trouble)
        out.print(told, soft_wrap=True)
    for words in near_groups(registry.GROUP):
        out.print(Text.assemble(("not found: ", "bold red"), words), soft_wrap=True)
    hidden = [told for plugin in found.plugins for told in hidden_commands(plugin)]
    for clash in [*found.clashes, *hidden]:
        out.print(Text.assemble(("clash: ", "bold red"), clash), soft_wrap=True)


def _broken_steps(found: registry.Registry) -> dict[str, str]:
    """Return what is wrong with each step that cannot be had, by name.

    Steps of others are imported, which tells for certain; the project's own, of which there are
    many, only where their source does not show them.
    """
    from tactile_graph.plugins.outline import outline

    broken = {}
    for name in found.names("steps"):
        offer = found.offer("steps", name)
        if offer.plugin.package == OWN and not outline(offer.target).trouble:
            continue
        try:
            found.step(name)
        except TactileGraphError as error:
            broken[name] = str(error)
    return broken


def _offers(found: registry.Registry, plugin: Plugin, broken: Mapping[str, str]) -> Any:
    from rich.text import Text

    if plugin.blocked:
        return Text("blocked", style="yellow")
    if plugin.error:
        return Text("failed to load, see below", style="red")
    usable = {**plugin.offers, "steps": [
        n for n in plugin.offers.get("steps", ())
        if found.spelled("steps", f"{plugin.name}.{n}") not in broken
    ]}  # fmt: skip
    parts = [
        f"{len(names)} {kind.replace('_', ' ') if len(names) != 1 else singular(kind)}"
        for kind, names in usable.items()
        if names
    ]
    n_broken = len(plugin.offers.get("steps", ())) - len(usable["steps"])
    parts += [f"{n_broken} of its steps cannot be used, see below"] if n_broken else []
    return Text(", ".join(parts) or "nothing", style="" if parts else "dim")
