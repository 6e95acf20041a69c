"""Between rows of the tables and records: all statements that read and write them."""

from __future__ import annotations

import sqlite3
from collections.abc import Sequence
from datetime import UTC, datetime
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph_classifiers.database.known import KnownObject
from tactile_graph_classifiers.database.statistics import Statistics

Array = NDArray[np.float64]


class Lesson(NamedTuple):
    """Readings of one object to be learned.

    Parameters
    ----------
    name : str
    shape : str
        Empty leaves the shape as it is.
    readings : ndarray, shape (n, F)
    sources : sequence of str
        Where each reading comes from.
    """

    name: str
    shape: str
    readings: Array
    sources: Sequence[str]


class Setting(NamedTuple):
    """What all readings of a database have in common.

    Parameters
    ----------
    features : tuple of str
    quantity : str
    pipeline : str
    """

    features: tuple[str, ...]
    quantity: str
    pipeline: str = ""


def setting_of(connection: sqlite3.Connection) -> Setting:
    """Return what all readings have in common; no features where nothing was learned yet."""
    features = tuple(r[0] for r in connection.execute("SELECT name FROM features ORDER BY id"))
    about = dict(connection.execute("SELECT key, value FROM about"))
    return Setting(features, about.get("quantity", ""), about.get("pipeline", ""))


def add(connection: sqlite3.Connection, lesson: Lesson) -> None:
    """Add a lesson's readings to its object, made if it is new, and to the statistics."""
    n, n_features = lesson.readings.shape
    row = connection.execute("SELECT id FROM objects WHERE name = ?", (lesson.name,)).fetchone()
    now = datetime.now(UTC).isoformat(timespec="seconds")
    if row is None:
        row = (_insert(connection, "INSERT INTO objects (name, shape, learned_at, n_readings)"
                       " VALUES (?, ?, ?, 0)", (lesson.name, lesson.shape, now)),)  # fmt: skip
    number = int(row[0])
    old = statistics_of(connection, number, n_features)
    for values, source in zip(lesson.readings.tolist(), lesson.sources, strict=True):
        of_reading = _insert(
            connection, "INSERT INTO readings (object_id, source) VALUES (?, ?)", (number, source)
        )
        cells = [(of_reading, k, v) for k, v in enumerate(values)]
        connection.executemany("INSERT INTO reading_values VALUES (?, ?, ?)", cells)
    store_statistics(connection, number, old.joined(Statistics.of(lesson.readings)))
    connection.execute(
        "UPDATE objects SET n_readings = n_readings + ?, learned_at = ?,"
        " shape = coalesce(nullif(?, ''), shape) WHERE id = ?",
        (n, now, lesson.shape, number),
    )


def _insert(connection: sqlite3.Connection, statement: str, values: tuple[object, ...]) -> int:
    number = connection.execute(statement, values).lastrowid
    assert number is not None
    return number


def statistics_of(connection: sqlite3.Connection, number: int, n_features: int) -> Statistics:
    """Return an object's statistics as they are kept."""
    (n,) = connection.execute("SELECT n_readings FROM objects WHERE id = ?", (number,)).fetchone()
    none = Statistics.none(n_features)
    for k, mean in connection.execute(
        "SELECT feature_id, mean FROM means WHERE object_id = ?", (number,)
    ):
        none.mean[k] = mean
    for a, b, scatter in connection.execute(
        "SELECT feature_a, feature_b, scatter FROM scatters WHERE object_id = ?", (number,)
    ):
        none.scatter[a, b] = none.scatter[b, a] = scatter
    return Statistics(int(n), none.mean, none.scatter)


def store_statistics(connection: sqlite3.Connection, number: int, statistics: Statistics) -> None:
    """Keep an object's statistics in place of those before."""
    means = [(number, k, mean) for k, mean in enumerate(statistics.mean.tolist())]
    connection.executemany("INSERT OR REPLACE INTO means VALUES (?, ?, ?)", means)
    scatters = [
        (number, a, b, value)
        for a, row in enumerate(statistics.scatter.tolist())
        for b, value in enumerate(row)
        if a <= b
    ]
    connection.executemany("INSERT OR REPLACE INTO scatters VALUES (?, ?, ?, ?)", scatters)


def objects_of(connection: sqlite3.Connection, n_features: int) -> list[KnownObject]:
    """Return the objects with all their readings, in the order they were first learned."""
    cells: dict[int, list[float]] = {}
    sources: dict[int, list[str]] = {}
    for number, source in connection.execute("SELECT object_id, source FROM readings ORDER BY id"):
        sources.setdefault(number, []).append(source)
    for number, value in connection.execute(
        "SELECT r.object_id, v.value FROM readings r JOIN reading_values v ON v.reading_id = r.id"
        " ORDER BY r.id, v.feature_id"
    ):
        cells.setdefault(number, []).append(value)
    query = "SELECT id, name, shape FROM objects ORDER BY id"
    return [
        KnownObject(
            name,
            shape,
            np.array(cells.get(number, []), dtype=np.float64).reshape(-1, n_features),
            statistics_of(connection, number, n_features),
            tuple(sources.get(number, [])),
        )
        for number, name, shape in connection.execute(query).fetchall()
    ]
