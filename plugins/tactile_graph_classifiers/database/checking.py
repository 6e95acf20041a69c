"""Object databases and their exports as ``check`` takes them."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from tactile_graph.plugins.file_check import Checked, FileCheck

if TYPE_CHECKING:
    from tactile_graph_classifiers.database.rows import Setting

HEAD_BYTES = 4096
"""Within which a file says what it is."""
_SQLITE = b"SQLite format 3\0"
_OWNER_AT = 68
"""Where an SQLite file says whose it is, in 4 bytes."""


def is_database(path: Path) -> bool:
    """Return whether a file is an SQLite file that says it is a database of objects."""
    from tactile_graph_classifiers.database.schema import APPLICATION_ID

    head = _head(path)
    owner = int.from_bytes(head[_OWNER_AT : _OWNER_AT + 4], "big")
    return head.startswith(_SQLITE) and owner == APPLICATION_ID


def is_export(path: Path) -> bool:
    """Return whether a file says at its top that it is an export of such a database."""
    from tactile_graph_classifiers.database.text import FORMAT

    return f"format: {FORMAT}".encode() in _head(path).splitlines()


def check_database(path: Path, repair: bool = False) -> Checked:
    """Return what a database holds, all of it read and held against its seals.

    Raises
    ------
    DataError
        If it is damaged, locked, or of another version.
    """
    from tactile_graph_classifiers.database.store import ObjectDatabase

    database = ObjectDatabase(path)
    known, _ = database.presses()
    database.reliefs()
    n_readings = sum(it.statistics.n for it in known.objects)
    words = _words(len(known.objects), n_readings, known.quantity, known.pipeline)
    return Checked(f"object database: {words}")


def check_export(path: Path, repair: bool = False) -> Checked:
    """Return what an export holds.

    Raises
    ------
    DataError
        If it cannot be imported.
    """
    from tactile_graph_classifiers.database.text import read_export

    setting: Setting
    setting, lessons = read_export(path)
    n_readings = sum(len(lesson.readings) for lesson in lessons)
    words = _words(len(lessons), n_readings, setting.quantity, setting.pipeline)
    return Checked(f"export of an object database: {words}")


def _words(n_objects: int, n_readings: int, quantity: str, pipeline: str) -> str:
    things = "1 object" if n_objects == 1 else f"{n_objects} objects"
    seen = "1 reading" if n_readings == 1 else f"{n_readings} readings"
    unit = f" in {quantity}" if quantity else ""
    by = f", measured by {pipeline}" if pipeline else ""
    return f"{things}, {seen}{unit}{by}"


def _head(path: Path) -> bytes:
    """Return how a file begins; nothing of what can be read only once, or not at all."""
    try:
        if not path.is_file():
            return b""
        with path.open("rb") as file:
            return file.read(HEAD_BYTES)
    except OSError:
        return b""


DATABASE = FileCheck(is_database, check_database)
EXPORT = FileCheck(is_export, check_export)
