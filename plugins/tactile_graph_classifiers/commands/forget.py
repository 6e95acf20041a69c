"""``tactile-graph forget``: an object out of the database."""

from __future__ import annotations

from pathlib import Path

import click

from tactile_graph.cli.say import say
from tactile_graph_classifiers.commands.shared import database_option, tell_apart


@click.command()
@click.argument("name")
@click.option("--recording", metavar="FILE", default="",
              help="Only its readings of FILE, named as when it was learned.")  # fmt: skip
@database_option
def forget(name: str, recording: str, database: Path, timeout_s: float) -> None:
    """Forget the object NAME and all its readings, or those of one recording."""
    from tactile_graph_classifiers.database.names import known_as
    from tactile_graph_classifiers.database.store import ObjectDatabase

    store = ObjectDatabase(database, timeout_s)
    n = store.forget(name, recording)
    left = known_as(name, store.known().names) if recording else None
    if left is None:
        say(f"{database}: {name} forgotten, with {n} readings")
    else:
        say(f"{database}: {n} readings of {left} forgotten, those of {recording}")
    tell_apart(store)
