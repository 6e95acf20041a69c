"""The options every command takes, a plugin's too: which plugins may load, and ``--debug``."""

from __future__ import annotations

import os

import click

from tactile_graph.errors import UsageError, did_you_mean, one_of
from tactile_graph.plugins import registry


def add_options(command: click.Command) -> None:
    """Give a command, and those within it, the shared options where it has none of its own so."""
    taken = {name for p in command.params for name in p.opts}
    for option in (_plugins(), _debug()):
        if not taken & set(option.opts):
            command.params.append(option)
    if isinstance(command, click.Group):
        for within in command.commands.values():
            add_options(within)


def _plugins() -> click.Option:
    return click.Option(
        ["--plugins"],
        metavar="SELECTION",
        is_eager=True,
        expose_value=False,
        callback=_restrict,
        help="Load only these plugins (hull,filters) or all but these (-mrf); goes before the "
        f"environment variable {registry.ENVIRONMENT}.",
    )


def _debug() -> click.Option:
    return click.Option(
        ["--debug"],
        is_flag=True,
        expose_value=False,
        help="Show the traceback of an error.",
    )


def _restrict(ctx: click.Context, param: click.Parameter, value: str | None) -> None:
    if value is not None:
        registry.restrict(value)
    given = registry.selected()
    if value is None and (ctx.resilient_parsing or given != os.environ.get(registry.ENVIRONMENT)):
        return
    wanted = registry.Selection.parse(given)
    names = [p.name for p in registry.installed().plugins]
    for name in sorted(wanted.only | wanted.blocked):
        if name not in names:
            hint = did_you_mean(name, names) or f"; there are: {one_of(names)}"
            option = registry.ENVIRONMENT if value is None else "--plugins"
            raise UsageError(f"{option}: no plugin named {name!r}{hint}")
