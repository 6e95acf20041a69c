"""What the commands about known objects share: the database, and tables for people."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from tactile_graph.cli.numbers import Finite
from tactile_graph.cli.say import say

if TYPE_CHECKING:
    from tactile_graph.api.pipeline import Pipeline
    from tactile_graph_classifiers.database.known import Known
    from tactile_graph_classifiers.database.store import ObjectDatabase

F = TypeVar("F", bound=Callable[..., Any])
DEFAULT_DATABASE = "tactile-objects.sqlite"


def database_option(command: F) -> F:
    """Add ``--database`` and ``--wait``."""
    for add in (
        click.option(
            "--wait",
            "timeout_s",
            type=Finite(min=0.0),
            default=5.0,
            show_default=True,
            metavar="SECONDS",
            help="How long to wait while another program writes to the database.",
        ),
        click.option(
            "--database",
            type=click.Path(path_type=Path),
            default=DEFAULT_DATABASE,
            show_default=True,
            help="The object database, an SQLite file.",
        ),
    ):
        command = add(command)
    return command


def tell_apart(store: ObjectDatabase) -> None:
    """Find how the objects of a database are told apart best, keep it, and say how well.

    Parameters
    ----------
    store : ObjectDatabase
    """
    from tactile_graph_classifiers.distances.choosing import choose
    from tactile_graph_classifiers.distances.examples import Examples
    from tactile_graph_classifiers.distances.left_out_recordings import by_recording

    known = store.known()
    if len(known.objects) < 2 or max(len(it.readings) for it in known.objects) < 2:
        return
    choice = choose(Examples.of(known))
    store.keep(choice, known)
    say(f"{store.path}: {choice}")
    for line in by_recording(known, choice.manner).lines() if choice.n_left_out else ():
        say(line, err=True)
    if known.few:
        tell_few(known)


def tell_few(known: Known) -> None:
    """Say that how well objects are told apart is not known by few readings.

    Parameters
    ----------
    known : Known
        Of which some object has few.
    """
    say(f"these shares tell little yet: {known.few}, which leave it guessing how much one object"
        " varies; learn more", err=True)  # fmt: skip


def tell_assumed_pad(pipeline: Pipeline, settings: Sequence[str]) -> None:
    """Say that volts were made another quantity by a pad that nobody named, if none was.

    Parameters
    ----------
    pipeline : Pipeline
    settings : sequence of str
        What ``--set`` says.
    """
    assumed, named = {}, any(".pad=" in setting for setting in settings)
    for name, node in pipeline.nodes.items():
        for one in node.signature.settings if node.signature is not None else ():
            if one.name == "pad":
                assumed[name] = one.default
                named |= node.settings.get("pad") != one.default
    pad = next((str(default) for default in assumed.values() if default), "")
    if pad and not named:
        told = " ".join(f"--set {name}.pad=FILE" for name in assumed)
        say(f"the volts were taken for those of pad {pad!r}, by its circuit and law; those of"
            f" another pad give no true weights: name it with {told}, or keep them as they are with"
            " --with quantity=raw, in learn and identify alike", err=True)  # fmt: skip


def print_table(title: str, columns: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    """Write a table to stdout.

    Parameters
    ----------
    title : str
    columns : sequence of str
        The first is of texts, the others of numbers unless they end in a space.
    rows : sequence of sequence of str
    """
    from rich.table import Table
    from rich.text import Text

    from tactile_graph.cli.terminal import console

    table = Table(box=None, pad_edge=False)
    for i, name in enumerate(columns):
        right = i > 0 and not name.endswith(" ")
        table.add_column(Text(name.strip()), justify="right" if right else "left", no_wrap=True)
    for row in rows:
        table.add_row(*(Text(cell) for cell in row))
    out = console()
    out.print(Text(title, "bold"), soft_wrap=True)
    out.print(table)
