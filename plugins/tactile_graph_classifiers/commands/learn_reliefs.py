"""``tactile-graph learn-reliefs``: known objects' reliefs, of the presses that were kept."""

from __future__ import annotations

from pathlib import Path

import click

from tactile_graph.cli.say import say
from tactile_graph.errors import one_of
from tactile_graph_classifiers.commands.shared import database_option


@click.command("learn-reliefs")
@database_option
def learn_reliefs(database: Path, timeout_s: float) -> None:
    """Learn the relief of every known object, of presses that 'learn --keep-presses' kept.

    How the pad reads is learned with them, and how far presses are from their own relief where it
    was learned without them, by which strangers are told. An object of 20 presses takes ten seconds
    on a pad of 16 x 16 cells, more on a larger one. Where other work keeps the processors busy,
    OPENBLAS_NUM_THREADS=1 in the environment keeps that from being several times as long. Learn
    again when readings were added. 'tactile-graph identify --pipeline identify-reliefs' then names
    presses by them.
    """
    from tactile_graph.compiled import warm_up
    from tactile_graph_classifiers.database.store import ObjectDatabase
    from tactile_graph_classifiers.reliefs.of_database import learned_of

    warm_up()
    store = ObjectDatabase(database, timeout_s)
    known, presses = store.presses()
    found = learned_of(known, presses, lambda text: say(f"{database}: {text}"))
    store.keep_reliefs(found.kept(), known)
    say(f"{database}: reliefs of {len(found.names)} objects learned")
    if vary := found.explained_poorly():
        say(
            f"{database}: reliefs explain these readings poorly: they vary by {100 * vary:.0f} %"
            " beside them, and names by them are little sure; is each object pressed on one face,"
            " whole on the pad, well above the noise and below full scale?",
            err=True,
        )
    if badly := found.badly_learned():
        say(
            f"{database}: presses of {one_of(badly, 30)} fit their own relief badly when left out;"
            " learn more of them, then reliefs again",
            err=True,
        )
