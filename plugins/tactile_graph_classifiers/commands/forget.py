"""``tactile-graph forget``: an object out of the database."""

from __future__ import annotations

from pathlib import Path

import click

from tactile_graph_classifiers.commands.shared import database_option, tell_apart


@click.command()
@click.argument("name")
@database_option
def forget(name: str, database: Path, timeout_s: float) -> None:
    """Forget the object NAME and all its readings."""
    from tactile_graph_classifiers.database.store import ObjectDatabase

    store = ObjectDatabase(database, timeout_s)
    n = store.forget(name)
    click.echo(f"{database}: {name} forgotten, with {n} readings")
    tell_apart(store)
