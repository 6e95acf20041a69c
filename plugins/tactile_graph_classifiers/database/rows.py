"""Between rows of the tables and records: all statements that read and write them."""

from __future__ import annotations

import sqlite3
from collections.abc import Sequence
from dataclasses import replace
from datetime import UTC, datetime
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError
from tactile_graph_classifiers.database.choice import Choice, Manner
from tactile_graph_classifiers.database.instrument import Instrument
from tactile_graph_classifiers.database.known import KnownObject
from tactile_graph_classifiers.database.schema import INSTRUMENT
from tactile_graph_classifiers.database.seal import seal, seal_of_object
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
    instrument : Instrument, optional
        None where nobody said, as in databases of earlier versions.
    """

    features: tuple[str, ...]
    quantity: str
    pipeline: str = ""
    instrument: Instrument | None = None


class StoredObject(NamedTuple):
    """An object as a row has it.

    Parameters
    ----------
    number : int
    learned_at : str
    known : KnownObject
    """

    number: int
    learned_at: str
    known: KnownObject


class Contents(NamedTuple):
    """All that a database says.

    Parameters
    ----------
    setting : Setting
        No features where nothing was learned yet.
    objects : tuple of StoredObject
        In the order they were first learned.
    choice : Choice, optional
    """

    setting: Setting
    objects: tuple[StoredObject, ...]
    choice: Choice | None


# -- reading ---------------------------------------------------------------------------------


def contents(connection: sqlite3.Connection, where: str) -> Contents:
    """Return all that a database says, its seals verified.

    Parameters
    ----------
    connection : sqlite3.Connection
    where : str
        The file, for errors.

    Raises
    ------
    DataError
        If anything in it is not as it was written.
    """
    about = connection.execute("SELECT quantity, pipeline, seal FROM about").fetchall()
    features = connection.execute("SELECT id, name FROM features ORDER BY id").fetchall()
    rows = connection.execute(
        "SELECT id, name, shape, learned_at, n_readings, seal FROM objects ORDER BY id"
    ).fetchall()
    if not about and not features and not rows:
        return Contents(Setting((), ""), (), None)
    _typed(about, (str, str, str), where)
    _typed(features, (int, str), where)
    _typed(rows, (int, str, str, str, int, str), where)
    if len(about) != 1 or [k for k, _ in features] != list(range(len(features))):
        raise damaged(where, "rows are missing or there are too many")
    quantity, pipeline, sealed = about[0]
    names = tuple(name for _, name in features)
    setting = Setting(names, quantity, pipeline, _instrument(connection, where))
    objects = tuple(_object(connection, row, len(features), where) for row in rows)
    found = Contents(setting, objects, _choice(connection, where))
    if _whole_seal(found, [row[-1] for row in rows]) != sealed:
        raise damaged(where, "its objects are not those that were learned")
    return found


def damaged(where: str, what: str) -> DataError:
    """Return the error that a database is not as it was written."""
    return DataError(
        where, f"is damaged, or was edited by another program: {what}; take a copy, or an export"
    )


def _typed(rows: Sequence[tuple[Any, ...]], types: tuple[type, ...], where: str) -> None:
    for row in rows:
        if any(type(value) is not kind for value, kind in zip(row, types, strict=True)):
            raise damaged(where, "a value is of another type")


def _object(
    connection: sqlite3.Connection, row: tuple[Any, ...], n_features: int, where: str
) -> StoredObject:
    number, name, shape, learned_at, n, sealed = row
    query = "SELECT source FROM readings WHERE object_id = ? ORDER BY id"
    sources = connection.execute(query, (number,)).fetchall()
    _typed(sources, (str,), where)
    cells = connection.execute(
        "SELECT v.feature_id, v.value FROM readings r JOIN reading_values v ON v.reading_id = r.id"
        " WHERE r.object_id = ? ORDER BY r.id, v.feature_id",
        (number,),
    ).fetchall()
    means = connection.execute(
        "SELECT feature_id, mean FROM means WHERE object_id = ? ORDER BY feature_id", (number,)
    ).fetchall()
    scatters = connection.execute(
        "SELECT feature_a, feature_b, scatter FROM scatters WHERE object_id = ?"
        " ORDER BY feature_a, feature_b",
        (number,),
    ).fetchall()
    _typed(cells, (int, float), where)
    _typed(means, (int, float), where)
    _typed(scatters, (int, int, float), where)
    features = list(range(n_features))
    above = np.triu_indices(n_features)
    if (
        len(sources) != n
        or [k for k, _ in cells] != features * n
        or [k for k, _ in means] != features
        or [s[:2] for s in scatters] != list(zip(*(at.tolist() for at in above), strict=True))
    ):
        raise damaged(where, f"readings or statistics of {name!r} are missing")
    scatter = np.zeros((n_features, n_features))
    scatter[above] = [s for *_, s in scatters]
    scatter.T[above] = scatter[above]
    statistics = Statistics(n, np.array([m for _, m in means], dtype=np.float64), scatter)
    readings = np.array([v for _, v in cells], dtype=np.float64).reshape(n, n_features)
    known = KnownObject(name, shape, readings, statistics, tuple(s for (s,) in sources))
    if seal_of_object(known, learned_at) != sealed:
        raise damaged(where, f"{name!r} is not what was learned")
    return StoredObject(number, learned_at, known)


_CHOICE_TYPES = (float, int, float, float, int, int, int, int)


def _choice(connection: sqlite3.Connection, where: str) -> Choice | None:
    rows = connection.execute(
        "SELECT shrinkage, variates, prior_readings, beyond, n_left_out, n_right, n_strangers,"
        " n_found FROM choice"
    ).fetchall()
    _typed(rows, _CHOICE_TYPES, where)
    if len(rows) > 1:
        raise damaged(where, "there are two choices")
    return Choice(Manner(*rows[0][:4]), *rows[0][4:]) if rows else None


def _instrument(connection: sqlite3.Connection, where: str) -> Instrument | None:
    query = "SELECT count(*) FROM sqlite_master WHERE type = 'table' AND name = 'instrument'"
    if connection.execute(query).fetchone() == (0,):
        return None
    rows = connection.execute(
        "SELECT rows, columns, pitch_x_cm, pitch_y_cm, seal FROM instrument"
    ).fetchall()
    _typed(rows, (int, int, float, float, str), where)
    if len(rows) != 1 or seal(rows[0][:-1]) != rows[0][-1]:
        raise damaged(where, "its instrument is not the one that was learned on")
    return Instrument(*rows[0][:-1])


def _whole_seal(found: Contents, seals: Sequence[str]) -> str:
    setting, choice = found.setting, found.choice
    of_choice = (*choice.manner, *choice[1:]) if choice else ()
    return seal(
        (len(setting.features), *setting.features, setting.quantity, setting.pipeline,
         *of_choice, len(seals), *seals)
    )  # fmt: skip


# -- writing ---------------------------------------------------------------------------------


def add(connection: sqlite3.Connection, lesson: Lesson, old: KnownObject | None) -> KnownObject:
    """Add a lesson's readings to its object, made if it is new; return it as it is now.

    Parameters
    ----------
    connection : sqlite3.Connection
    lesson : Lesson
        Of at least one reading.
    old : KnownObject, optional
        The object as it is.
    """
    now = datetime.now(UTC).isoformat(timespec="seconds")
    statistics, readings = Statistics.of(lesson.readings), lesson.readings
    shape, sources = lesson.shape, tuple(lesson.sources)
    if old is not None:
        statistics = old.statistics.joined(statistics)
        readings = np.concatenate([old.readings, readings])
        shape, sources = shape or old.shape, (*old.sources, *sources)
    known = KnownObject(lesson.name, shape, readings, statistics, sources)
    values = (known.shape, now, statistics.n, seal_of_object(known, now), known.name)
    if old is None:
        columns = "(shape, learned_at, n_readings, seal, name)"
        connection.execute(f"INSERT INTO objects {columns} VALUES (?, ?, ?, ?, ?)", values)
    else:
        changes = "shape = ?, learned_at = ?, n_readings = ?, seal = ?"
        connection.execute(f"UPDATE objects SET {changes} WHERE name = ?", values)
    query = "SELECT id FROM objects WHERE name = ?"
    ((number,),) = connection.execute(query, (known.name,)).fetchall()
    for row, source in zip(lesson.readings.tolist(), lesson.sources, strict=True):
        statement = "INSERT INTO readings (object_id, source) VALUES (?, ?)"
        of_reading = connection.execute(statement, (number, source)).lastrowid
        cells = [(of_reading, k, value) for k, value in enumerate(row)]
        connection.executemany("INSERT INTO reading_values VALUES (?, ?, ?)", cells)
    store_statistics(connection, number, statistics)
    return known


def rename(connection: sqlite3.Connection, it: StoredObject, name: str) -> None:
    """Give an object another name."""
    sealed = seal_of_object(replace(it.known, name=name), it.learned_at)
    values = (name, sealed, it.number)
    connection.execute("UPDATE objects SET name = ?, seal = ? WHERE id = ?", values)


def keep_readings(connection: sqlite3.Connection, it: StoredObject, kept: Sequence[int]) -> None:
    """Keep some of an object's readings, counted from 0, and remove the others."""
    query = "SELECT id FROM readings WHERE object_id = ? ORDER BY id"
    numbers = connection.execute(query, (it.number,)).fetchall()
    gone = [numbers[k] for k in sorted({*range(len(numbers))} - {*kept})]
    connection.executemany("DELETE FROM readings WHERE id = ?", gone)
    readings = it.known.readings[list(kept)]
    known = replace(
        it.known,
        readings=readings,
        statistics=Statistics.of(readings),
        sources=tuple(it.known.sources[k] for k in kept),
    )
    values = (len(kept), seal_of_object(known, it.learned_at), it.number)
    connection.execute("UPDATE objects SET n_readings = ?, seal = ? WHERE id = ?", values)
    store_statistics(connection, it.number, known.statistics)


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


def settle(connection: sqlite3.Connection, setting: Setting, choice: Choice | None) -> None:
    """Write what all readings have in common and the choice, and seal the whole.

    Parameters
    ----------
    connection : sqlite3.Connection
    setting : Setting
    choice : Choice, optional
        None where the objects are others than a choice was made for.
    """
    connection.execute("DELETE FROM choice")
    if choice is not None:
        values = (*choice.manner, *choice[1:])
        connection.execute("INSERT INTO choice VALUES (1, ?, ?, ?, ?, ?, ?, ?, ?)", values)
    seals = [row[0] for row in connection.execute("SELECT seal FROM objects ORDER BY id")]
    sealed = _whole_seal(Contents(setting, (), choice), seals)
    features = list(enumerate(setting.features))
    connection.executemany("INSERT OR IGNORE INTO features VALUES (?, ?)", features)
    connection.execute(
        "INSERT OR REPLACE INTO about VALUES (1, ?, ?, ?)",
        (setting.quantity, setting.pipeline, sealed),
    )
    if setting.instrument is not None:
        connection.execute(INSTRUMENT)
        instrument = Instrument.of(*setting.instrument)
        row = (*instrument, seal(instrument))
        connection.execute("INSERT OR REPLACE INTO instrument VALUES (1, ?, ?, ?, ?, ?)", row)
