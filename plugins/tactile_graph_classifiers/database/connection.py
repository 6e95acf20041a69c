"""Open an object database and tell in words what is wrong with it.

The journal is SQLite's rollback journal, not a write-ahead log: a database is then one file that
can be copied, sent and put on a read-only disc. Transactions are short (features are measured
before one begins), so readers and writers wait for each other by milliseconds.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from urllib.parse import quote

from tactile_graph.errors import DataError, did_you_mean
from tactile_graph_classifiers.database.schema import APPLICATION_ID, TABLES, VERSION


@contextmanager
def reading(path: Path, timeout_s: float) -> Iterator[sqlite3.Connection]:
    """Give a connection within a transaction that sees one state of the database.

    Parameters
    ----------
    path : Path
    timeout_s : float
        How long to wait for another program that is writing.

    Raises
    ------
    DataError
        If there is no such file, or it is no object database this version can read.
    """
    _must_exist(path)
    with _opened(path, "rw", timeout_s) as connection, _transaction(connection, "BEGIN"):
        if not _is_made(connection, path):
            raise DataError(str(path), "is empty: no object was learned yet")
        yield connection


@contextmanager
def writing(path: Path, timeout_s: float, create: bool = False) -> Iterator[sqlite3.Connection]:
    """Give a connection within a transaction that is kept whole or not at all.

    Parameters
    ----------
    path : Path
    timeout_s : float
    create : bool
        Whether to make the file and its tables where there are none.

    Raises
    ------
    DataError
        As `reading`; or if the file cannot be written.
    """
    if not create:
        _must_exist(path)
    elif not path.parent.is_dir():
        raise DataError(str(path), f"there is no folder {str(path.parent)!r}")
    mode = "rwc" if create else "rw"
    with _opened(path, mode, timeout_s) as connection, _transaction(connection, "BEGIN IMMEDIATE"):
        if not _is_made(connection, path):
            if not create:
                raise DataError(str(path), "is empty: no object was learned yet")
            _make(connection)
        yield connection


def _must_exist(path: Path) -> None:
    if path.is_file():
        return
    if path.is_dir():
        raise DataError(str(path), "is a folder, not an object database")
    siblings = [p.name for p in path.parent.iterdir()] if path.parent.is_dir() else []
    hint = did_you_mean(path.name, siblings)
    raise DataError(
        str(path), f"there is no such object database{hint}; 'tactile-graph learn' makes one"
    )


@contextmanager
def _opened(path: Path, mode: str, timeout_s: float) -> Iterator[sqlite3.Connection]:
    connection = None
    try:
        # A reader opens for writing too: it may have to roll back what a killed writer left.
        connection = sqlite3.connect(
            f"file:{quote(str(path))}?mode={mode}",
            timeout=timeout_s,
            uri=True,
            isolation_level=None,
        )
        # What is no UTF-8 any more must reach the seals, not end in an error of another kind.
        connection.text_factory = lambda raw: raw.decode("utf-8", "replace")
        connection.execute("PRAGMA foreign_keys = ON")
        yield connection
    except sqlite3.Error as error:
        raise DataError(str(path), _words(error, path, timeout_s)) from error
    except UnicodeDecodeError as error:  # SQLite's own words quote a damaged name
        raise DataError(str(path), "is damaged: a name in it is no text; take a copy, or an export,"
                        " of it") from error  # fmt: skip
    finally:
        if connection is not None:
            connection.close()


@contextmanager
def _transaction(connection: sqlite3.Connection, begin: str) -> Iterator[None]:
    connection.execute(begin)
    try:
        yield
    except BaseException:
        if connection.in_transaction:
            connection.execute("ROLLBACK")
        raise
    connection.execute("COMMIT")


def _is_made(connection: sqlite3.Connection, path: Path) -> bool:
    """Return whether the tables are there.

    Raises
    ------
    DataError
        If the file is another program's, or of a newer version.
    """
    (owner,) = connection.execute("PRAGMA application_id").fetchone()
    (version,) = connection.execute("PRAGMA user_version").fetchone()
    if owner == 0 and version == 0:
        (n_tables,) = connection.execute("SELECT count(*) FROM sqlite_master").fetchone()
        if n_tables == 0:
            return False
    if owner != APPLICATION_ID:
        raise DataError(str(path), "is an SQLite database, but not one of objects")
    if version != VERSION:
        todo = (
            "update tactile-graph" if version > VERSION else
            "export it with the version that made it ('objects --export'), and import that"
        )  # fmt: skip
        raise DataError(
            str(path),
            f"has schema {version}, this version of the plugin reads schema {VERSION}; {todo}",
        )
    strange = connection.execute(
        "SELECT type, name FROM sqlite_master WHERE type NOT IN ('table', 'index')"
    ).fetchone()
    if strange is not None:  # a view may have rows without end
        kind, name = strange
        raise DataError(str(path), f"holds a {kind} {name!r}, which no database of objects has")
    return True


def _make(connection: sqlite3.Connection) -> None:
    for statement in TABLES.split(";\n"):
        connection.execute(statement)
    connection.execute(f"PRAGMA application_id = {APPLICATION_ID}")
    connection.execute(f"PRAGMA user_version = {VERSION}")


def _words(error: sqlite3.Error, path: Path, timeout_s: float) -> str:
    code = getattr(error, "sqlite_errorcode", 0) & 0xFF
    if code in (sqlite3.SQLITE_BUSY, sqlite3.SQLITE_LOCKED):
        return f"is locked by another program since {timeout_s:g} s; try again when that is done"
    if code == sqlite3.SQLITE_NOTADB:
        return "is no object database: not an SQLite file"
    if code == sqlite3.SQLITE_READONLY:
        return "cannot be written: file or folder is read-only"
    if code == sqlite3.SQLITE_CANTOPEN:
        return "cannot be opened; may file and folder be read and written?"
    if code in (sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_ERROR, sqlite3.SQLITE_CONSTRAINT):
        return f"is damaged: {error}; take a copy, or an export, of it"
    if code == sqlite3.SQLITE_FULL:
        return "cannot be written: the disc is full"
    return f"SQLite: {error}"
