"""``check`` knows object databases and their exports, and reads all of them."""

from __future__ import annotations

import sqlite3
from pathlib import Path

import numpy as np
import pytest

from helpers_classifiers import SETTING, three_objects
from helpers_cli import call
from tactile_graph_classifiers.database.checking import is_database, is_export
from tactile_graph_classifiers.database.opening import SAMPLE
from tactile_graph_classifiers.database.rows import Lesson
from tactile_graph_classifiers.database.store import ObjectDatabase
from tactile_graph_classifiers.database.text import to_text


@pytest.fixture
def database(tmp_path: Path) -> ObjectDatabase:
    made = ObjectDatabase(tmp_path / "objects.db")
    made.learn(SETTING, [Lesson(n, "disc", r, [""] * len(r)) for n, r in three_objects().items()])
    return made


def test_a_database_is_right(database: ObjectDatabase) -> None:
    got = call("check", database.path)
    assert got.exit_code == 0
    assert ": right  object database: 3 objects, 75 readings in gram" in got.stdout


def test_an_export_is_right_and_no_scene(database: ObjectDatabase, tmp_path: Path) -> None:
    path = tmp_path / "objects.yaml"
    path.write_text(to_text(database.known()), encoding="utf-8")
    got = call("check", path, SAMPLE)
    assert got.exit_code == 0
    assert ": right  export of an object database: 3 objects, 75 readings in gram" in got.stdout
    assert "7 objects, 175 readings in gram" in got.stdout
    path.write_text(path.read_text("utf-8").replace("name:", "nam:", 1), encoding="utf-8")
    got = call("check", path)
    assert got.exit_code == 2
    assert "object 1: must be a mapping with a name" in got.stdout


def test_a_database_whose_readings_were_changed_is_wrong(database: ObjectDatabase) -> None:
    with sqlite3.connect(database.path) as connection:
        connection.execute("UPDATE objects SET name = 'other' WHERE id = 1")
    connection.close()
    got = call("check", database.path)
    assert got.exit_code == 2
    assert "objects.db: wrong" in got.stdout


def test_other_files_are_neither(tmp_path: Path) -> None:
    other = tmp_path / "other.db"
    with sqlite3.connect(other) as connection:
        connection.execute("CREATE TABLE a (b)")
    connection.close()
    np.save(tmp_path / "a.npy", np.zeros(3))
    for path in (other, tmp_path / "a.npy", tmp_path, tmp_path / "none"):
        assert not is_database(path)
        assert not is_export(path)
