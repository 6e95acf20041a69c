"""Known objects from wherever a classifier is told: a database, an export, or the sample."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

from tactile_graph.errors import DataError, one_of
from tactile_graph_classifiers.database.known import Known, KnownObject
from tactile_graph_classifiers.database.relief_rows import Kept
from tactile_graph_classifiers.database.statistics import Statistics

SAMPLE = Path(__file__).parents[1] / "samples" / "thesis-objects.yaml"
"""Readings of the objects of thesis tables 4.6 and 4.9 on the simulated pad."""

RELIEFS = SAMPLE.with_name("thesis-reliefs.sqlite")
"""The objects of table 4.9 with their reliefs, learned of simulated presses."""


def load_known(database: Path | dict[str, Any] | None, features: Sequence[str] | None) -> Known:
    """Return the objects of a database with the chosen features.

    Parameters
    ----------
    database : Path, mapping or None
        An SQLite file or an export, told apart by content; an export as plain data; or, if None,
        the sample that comes with the plugin.
    features : sequence of str, optional
        All that were learned if not given.

    Raises
    ------
    DataError
        If it cannot be read, or a feature was not learned.
    """
    if isinstance(database, dict):
        from tactile_graph_classifiers.database.text import from_data

        return _known(*from_data(database, "database"), "database").chosen(features)
    if database is None:
        return _sample().chosen(features)
    path = Path(database)
    if _is_export(path):
        from tactile_graph_classifiers.database.text import read_export

        return _known(*read_export(path), str(path)).chosen(features)
    from tactile_graph_classifiers.database.store import ObjectDatabase

    return ObjectDatabase(path).known().chosen(features)


def load_reliefs(database: Path | None) -> tuple[Known, Kept]:
    """Return the objects of a database and their reliefs.

    Parameters
    ----------
    database : Path or None
        An SQLite file; if None, the sample that comes with the plugin.

    Raises
    ------
    DataError
        If it cannot be read, or an object has no relief of its present readings.
    """
    from tactile_graph_classifiers.database.store import ObjectDatabase

    path = RELIEFS if database is None else Path(database)
    if _is_export(path):
        raise DataError(str(path), "is an export, which holds no reliefs; name the database itself")
    known, kept, lacking = ObjectDatabase(path).reliefs()
    if lacking:
        raise DataError(
            str(path),
            f"{one_of(lacking, 30)}: no relief was learned of the present readings; 'tactile-graph"
            " learn-reliefs' learns it",
        )
    return known, kept


def _is_export(path: Path) -> bool:
    """Return whether a file is to be read as an export: a text named as YAML."""
    if path.suffix not in (".yaml", ".yml") or not path.is_file():
        return False
    with path.open("rb") as file:
        return not file.read(16).startswith(b"SQLite format 3")


@lru_cache(maxsize=1)
def _sample() -> Known:
    from tactile_graph_classifiers.database.text import read_export

    return _known(*read_export(SAMPLE), SAMPLE.name)


def _known(setting: Any, lessons: Any, where: str) -> Known:
    objects = tuple(
        KnownObject(x.name, x.shape, x.readings, Statistics.of(x.readings), tuple(x.sources))
        for x in lessons
    )
    return Known(
        where, setting.features, setting.quantity, objects, setting.pipeline,
        instrument=setting.instrument,
    )  # fmt: skip
