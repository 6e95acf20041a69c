"""``tactile-graph objects``: what the database knows; exports and imports of it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click
import numpy as np

from tactile_graph.cli.say import hand_over, say
from tactile_graph.cli.targets import check_targets, refuse_existing
from tactile_graph.errors import UsageError
from tactile_graph_classifiers.commands.shared import (
    database_option,
    print_table,
    tell_apart,
    tell_few,
)

if TYPE_CHECKING:
    from tactile_graph_classifiers.database.known import Known, KnownObject

LISTED = ("weight", "area_cm2")


@click.command()
@click.argument("name", required=False)
@database_option
@click.option("--export", "exported", metavar="FILE",
              help="Write everything as YAML to FILE, or - for stdout.")  # fmt: skip
@click.option("--overwrite", is_flag=True, help="Write the export over a file that is there.")
@click.option("--import", "imported", type=click.Path(path_type=Path), metavar="FILE",
              help="Add the objects of an export, all or none.")  # fmt: skip
@click.option("--rename", "renamed", nargs=2, metavar="OLD NEW",
              help="Give the object OLD the name NEW; what was learned of it stays.")  # fmt: skip
@click.option("--merge", is_flag=True,
              help="With --rename: NEW may be an object, which the readings join.")  # fmt: skip
def objects(
    name: str | None,
    database: Path,
    timeout_s: float,
    exported: str | None,
    overwrite: bool,
    imported: Path | None,
    renamed: tuple[str, str] | None,
    merge: bool,
) -> None:
    """List the known objects, or mean and deviation of each feature of NAME."""
    from tactile_graph_classifiers.database.names import known_as, plain_name
    from tactile_graph_classifiers.database.store import ObjectDatabase

    if sum(given is not None for given in (name, exported, imported, renamed)) > 1:
        raise UsageError("give one of NAME, --export, --import and --rename")
    if merge and renamed is None:
        raise UsageError("--merge: goes with --rename OLD NEW")
    check_targets([("--export", exported)])
    if not overwrite:
        refuse_existing([("--export", exported)])
    store = ObjectDatabase(database, timeout_s)
    if imported is not None:
        from tactile_graph_classifiers.database.text import read_export

        setting, lessons = read_export(imported)
        store.learn(setting, lessons, new=True)
        say(f"{database}: {len(lessons)} objects imported")
        tell_apart(store)
        return
    if renamed is not None:
        n = store.rename(*renamed, merge=merge)
        say(f"{database}: {renamed[0]} is {plain_name(renamed[1])} now, {n} readings")
        if merge:
            tell_apart(store)
        return
    known = store.known()
    if exported is not None:
        _export(known, exported)
    elif name is None:
        _list(known)
    else:
        found = known_as(name, known.names)
        if found is None:
            raise store.unknown(name, known.names)
        _describe(known, known.objects[known.names.index(found)])


def _export(known: Known, file: str) -> None:
    from tactile_graph.files import write_whole
    from tactile_graph_classifiers.database.text import to_text

    text = to_text(known)
    if file == "-":
        hand_over(text)
        return
    write_whole(file, text)
    say(f"{file}: {len(known.objects)} objects exported")


def _list(known: Known) -> None:
    if not known.objects:
        say(f"{known.where}: no objects")
        return
    shown = [f for f in LISTED if f in known.features] or list(known.features[:2])
    rows = [
        [it.name, it.shape, str(it.statistics.n), *(_spread(known, it, f) for f in shown)]
        for it in known.objects
    ]
    unit = f", readings in {known.quantity}" if known.quantity else ""
    by = f", measured by {known.pipeline}" if known.pipeline else ""
    on = f", of {known.instrument}" if known.instrument else ""
    print_table(f"{known.where}{by}{unit}{on}", ["object", "shape ", "readings", *shown], rows)
    if known.choice is not None:
        say(f"{known.choice}.")
        if known.few:
            tell_few(known)


def _spread(known: Known, it: KnownObject, feature: str) -> str:
    k = known.features.index(feature)
    deviation = float(np.sqrt(it.statistics.covariance[k, k]))
    return f"{it.statistics.mean[k]:.4g} ± {deviation:.2g}"


def _describe(known: Known, it: KnownObject) -> None:
    rows = []
    for k, feature in enumerate(known.features):
        values = it.readings[:, k]
        deviation = float(np.sqrt(it.statistics.covariance[k, k]))
        numbers = (float(it.statistics.mean[k]), deviation, values.min(), values.max())
        rows.append([feature, *(f"{v:.4g}" for v in numbers)])
    title = f"{it.name}{f', {it.shape}' if it.shape else ''}, {it.statistics.n} readings"
    print_table(title, ["feature", "mean", "deviation", "least", "most"], rows)
