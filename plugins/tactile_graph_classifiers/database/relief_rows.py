"""Presses' images and learned reliefs in an object database: tables made when first needed.

Every array has a seal of its own and is checked for kind, shape and range before anybody takes it.
A relief also keeps the seal its object had when it was learned: readings learned since then make
it one of other presses.
"""

from __future__ import annotations

import math
import sqlite3
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph_classifiers.database.rows import damaged
from tactile_graph_classifiers.database.seal import seal

Array = NDArray[np.float64]
MOST_CELLS = 1_000_000
"""Of one array: more is no press and no relief."""
PAD = {
    "law": (1, 3), "gains": (None, None), "doubts": (None, None), "variances": (1, 3),
    "numbers": (1, 4),
}  # fmt: skip
"""Arrays about the pad; numbers are full scale, top, variance of the lean, and pitch in cm."""
OBJECT = {"depth": (None, None), "picture": (None, None), "numbers": (1, 5), "left_out": (1, None)}
"""About each object; numbers are usual and soft depth, depth by load (two), usual misfit."""

_TEXT = "TEXT NOT NULL CHECK (typeof({0}) = 'text')"
_SEAL = "TEXT NOT NULL CHECK (length({0}) = 64)"
_SIZE = "INTEGER NOT NULL CHECK ({0} > 0 AND {0} <= 1000000)"
TABLES = f"""
CREATE TABLE IF NOT EXISTS presses (      -- images that readings were measured of
    reading_id INTEGER PRIMARY KEY REFERENCES readings (id) ON DELETE CASCADE,
    pitch_cm REAL NOT NULL CHECK (pitch_cm > 0 AND pitch_cm < 9e999),
    rows {_SIZE.format("rows")},
    columns {_SIZE.format("columns")},
    data BLOB NOT NULL CHECK (length(data) = 8 * rows * columns),
    seal {_SEAL.format("seal")}
);
CREATE TABLE IF NOT EXISTS pad_arrays (   -- how the pad reads, learned with the reliefs
    name {_TEXT.format("name")} PRIMARY KEY,
    rows {_SIZE.format("rows")},
    columns {_SIZE.format("columns")},
    data BLOB NOT NULL CHECK (length(data) = 8 * rows * columns),
    seal {_SEAL.format("seal")}
);
CREATE TABLE IF NOT EXISTS relief_arrays (
    object_id INTEGER NOT NULL REFERENCES objects (id) ON DELETE CASCADE,
    name {_TEXT.format("name")},
    learned_of {_SEAL.format("learned_of")},   -- the object's seal then
    learned_on {_SEAL.format("learned_on")},   -- a digest of the pad's arrays
    rows {_SIZE.format("rows")},
    columns {_SIZE.format("columns")},
    data BLOB NOT NULL CHECK (length(data) = 8 * rows * columns),
    seal {_SEAL.format("seal")},
    PRIMARY KEY (object_id, name)
) WITHOUT ROWID
"""


class Press(NamedTuple):
    """The image a reading was measured of: its values, NaN where there is none, and pitch."""

    values: Array
    pitch_cm: float


class Kept(NamedTuple):
    """Learned reliefs as arrays.

    Parameters
    ----------
    pad : mapping
        The arrays that `PAD` names.
    objects : mapping
        Those that `OBJECT` names, by the object's name.
    """

    pad: Mapping[str, Array]
    objects: Mapping[str, Mapping[str, Array]]


def has_table(connection: sqlite3.Connection, name: str) -> bool:
    """Return whether there is such a table."""
    query = "SELECT count(*) FROM sqlite_master WHERE type = 'table' AND name = ?"
    return bool(connection.execute(query, (name,)).fetchone()[0])


def make_tables(connection: sqlite3.Connection) -> None:
    """Make the tables that are not there yet."""
    for statement in TABLES.split(";\n"):
        connection.execute(statement)


# -- presses ---------------------------------------------------------------------------------


def add_presses(connection: sqlite3.Connection, name: str, presses: Sequence[Press | None]) -> None:
    """Keep the images of an object's last readings, where there is one."""
    make_tables(connection)
    query = (
        "SELECT r.id FROM readings r JOIN objects o ON o.id = r.object_id WHERE o.name = ?"
        " ORDER BY r.id DESC LIMIT ?"
    )
    numbers = [k for (k,) in connection.execute(query, (name, len(presses)))][::-1]
    for number, press in zip(numbers, presses, strict=True):
        if press is None:
            continue
        values, pitch = np.asarray(press.values, dtype=np.float64), float(press.pitch_cm)
        row = (number, pitch, *values.shape, _bytes(values), seal((name, pitch, values)))
        connection.execute("INSERT INTO presses VALUES (?, ?, ?, ?, ?, ?)", row)


def rename_presses(connection: sqlite3.Connection, name: str, new: str, where: str) -> None:
    """Seal the images of an object anew, under the name that it is to have.

    Raises
    ------
    DataError
        If one is not as it was written.
    """
    presses = presses_of(connection, name, where)
    if not any(presses):
        return
    query = (
        "SELECT r.id FROM readings r JOIN objects o ON o.id = r.object_id WHERE o.name = ?"
        " ORDER BY r.id"
    )
    numbers = [k for (k,) in connection.execute(query, (name,))]
    rows = [
        (seal((new, press.pitch_cm, press.values)), number)
        for number, press in zip(numbers, presses, strict=True)
        if press is not None
    ]
    connection.executemany("UPDATE presses SET seal = ? WHERE reading_id = ?", rows)


def presses_of(connection: sqlite3.Connection, name: str, where: str) -> list[Press | None]:
    """Return the image of each reading of an object, None where it was not kept.

    Raises
    ------
    DataError
        If one is not as it was written.
    """
    if not has_table(connection, "presses"):
        query = "SELECT n_readings FROM objects WHERE name = ?"
        ((n,),) = connection.execute(query, (name,)).fetchall()
        return [None] * n
    query = (
        "SELECT p.pitch_cm, p.rows, p.columns, p.data, p.seal FROM readings r JOIN objects o"
        " ON o.id = r.object_id LEFT JOIN presses p ON p.reading_id = r.id WHERE o.name = ?"
        " ORDER BY r.id"
    )
    out: list[Press | None] = []
    for pitch, rows, columns, data, sealed in connection.execute(query, (name,)):
        if data is None:
            out.append(None)
            continue
        values = _array(rows, columns, data, where)
        if type(pitch) is not float or seal((name, pitch, values)) != sealed:
            raise damaged(where, f"a press of {name!r} is not what was learned")
        out.append(Press(values, pitch))
    return out


# -- reliefs ---------------------------------------------------------------------------------


def keep(connection: sqlite3.Connection, kept: Kept) -> None:
    """Keep reliefs in place of those before."""
    make_tables(connection)
    connection.execute("DELETE FROM pad_arrays")
    connection.execute("DELETE FROM relief_arrays")
    for name, values in kept.pad.items():
        row = (name, *values.shape, _bytes(values), seal((name, values)))
        connection.execute("INSERT INTO pad_arrays VALUES (?, ?, ?, ?, ?)", row)
    on = _digest(kept.pad)
    for number, owner, of in connection.execute("SELECT id, name, seal FROM objects").fetchall():
        for name, values in kept.objects.get(owner, {}).items():
            sealed = seal((owner, name, of, on, values))
            row = (number, name, of, on, *values.shape, _bytes(values), sealed)
            connection.execute("INSERT INTO relief_arrays VALUES (?, ?, ?, ?, ?, ?, ?, ?)", row)


def kept_in(connection: sqlite3.Connection, where: str) -> tuple[Kept, list[str]]:
    """Return the reliefs, and the objects that have none of just their readings.

    Raises
    ------
    DataError
        If an array is missing, or one is not as it was written.
    """
    objects = connection.execute("SELECT id, name, seal FROM objects ORDER BY id").fetchall()
    if not has_table(connection, "pad_arrays") or not has_table(connection, "relief_arrays"):
        return Kept({}, {}), [name for _, name, _ in objects]
    pad = {}
    for name, rows, columns, data, sealed in connection.execute("SELECT * FROM pad_arrays"):
        pad[name] = _array(rows, columns, data, where)
        if not isinstance(name, str) or seal((name, pad[name])) != sealed:
            raise damaged(where, "what was learned of the pad is not what is there")
    if pad:
        _complete(pad, PAD, where, "the pad")
    on, found, lacking = _digest(pad), {}, []
    for number, owner, of in objects:
        arrays = _relief(connection, number, (owner, of, on), where)
        if arrays:
            found[owner] = arrays
        else:
            lacking.append(owner)
    return Kept(pad, found), lacking


def _relief(
    connection: sqlite3.Connection, number: int, whose: tuple[str, str, str], where: str
) -> dict[str, Array]:
    """Return the arrays of an object's relief; none if they are of other readings."""
    owner, of, on = whose
    query = (
        "SELECT name, learned_of, learned_on, rows, columns, data, seal FROM relief_arrays"
        " WHERE object_id = ?"
    )
    out: dict[str, Array] = {}
    for name, was_of, was_on, rows, columns, data, sealed in connection.execute(query, (number,)):
        values = _array(rows, columns, data, where)
        texts = (owner, name, was_of, was_on)
        if not all(isinstance(t, str) for t in texts) or seal((*texts, values)) != sealed:
            raise damaged(where, f"the relief of {owner!r} is not what was learned")
        if was_of == of and was_on == on:
            out[name] = values
    if out:
        _complete(out, OBJECT, where, f"the relief of {owner!r}")
    return out


def _complete(
    arrays: Mapping[str, Array],
    wanted: Mapping[str, tuple[int | None, int | None]],
    where: str,
    what: str,
) -> None:
    """Check that there are all arrays, of their shapes, and finite but for what was not left out.

    Raises
    ------
    DataError
        If not.
    """
    good = set(arrays) == set(wanted)
    for name, shape in wanted.items() if good else ():
        values = arrays[name]
        good &= all(s in (None, n) for s, n in zip(shape, values.shape, strict=True))
        good &= name == "left_out" or bool(np.isfinite(values).all())
    if good and "gains" in arrays:
        good = arrays["gains"].shape == arrays["doubts"].shape
    if good and "depth" in arrays:
        n, m = arrays["depth"].shape
        good &= n == m >= 3 and n % 2 == 1 and arrays["picture"].shape == (n, n)
    if not good:
        raise damaged(where, f"arrays of {what} are missing or of another kind")


def _digest(arrays: Mapping[str, Array]) -> str:
    return seal([part for name in sorted(arrays) for part in (name, arrays[name])])


def _bytes(values: Array) -> bytes:
    return values.astype("<f8").tobytes()


def _array(rows: Any, columns: Any, data: Any, where: str) -> Array:
    sizes = (rows, columns)
    if (
        any(type(n) is not int or n < 1 for n in sizes)
        or math.prod(sizes) > MOST_CELLS
        or not isinstance(data, bytes)
        or len(data) != 8 * rows * columns
    ):
        raise damaged(where, "an array is of another size")
    return np.frombuffer(data, dtype="<f8").astype(np.float64).reshape(rows, columns)
