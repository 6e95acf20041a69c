"""A database that others read and write at the same time, that is killed, or is none."""

from __future__ import annotations

import os
import signal
import sqlite3
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest

from helpers_classifiers import MAT, SETTING, lesson
from tactile_graph.errors import DataError
from tactile_graph_classifiers.database.choice import Choice, Manner
from tactile_graph_classifiers.database.known import Known
from tactile_graph_classifiers.database.rows import Lesson
from tactile_graph_classifiers.database.statistics import Statistics
from tactile_graph_classifiers.database.store import ObjectDatabase

LESSON = 40

WRITER = """
import sys
import numpy as np
from tactile_graph_classifiers.database import rows as table
from tactile_graph_classifiers.database.rows import Lesson, Setting
from tactile_graph_classifiers.database.store import ObjectDatabase

store = table.store_statistics
def slow(connection, number, statistics):
    # all rows but the statistics are written by now: half a lesson is on the disc
    store(connection, number, statistics)
    if statistics.n > 80:
        connection.execute("PRAGMA cache_spill = 1")
        connection.execute("PRAGMA cache_size = 1")
        rows = [(number, "filler") for _ in range(4000)]
        connection.executemany("INSERT INTO readings (object_id, source) VALUES (?, ?)", rows)
        print("within", flush=True)
        sys.stdin.read()
table.store_statistics = slow
rng = np.random.default_rng(0)
database = ObjectDatabase(sys.argv[1])
for k in range(3):
    rows = rng.normal(1000.0, 10.0, (40, 2))
    database.learn(Setting(("weight", "area_cm2"), "gram", "features"),
                   [Lesson("x", "", rows, [""] * 40)])
    print("learned", k, flush=True)
"""

LOOP = """
import sys
import numpy as np
from tactile_graph_classifiers.database.rows import Lesson, Setting
from tactile_graph_classifiers.database.store import ObjectDatabase
rng = np.random.default_rng(0)
database = ObjectDatabase(sys.argv[1])
while True:
    rows = rng.normal(1000.0, 10.0, (40, 2))
    database.learn(Setting(("weight", "area_cm2"), "gram", "features"),
                   [Lesson("x", "", rows, [""] * 40)])
    print("learned", flush=True)
"""


def whole(path: Path) -> int:
    """Check that the database is whole and its statistics fit; return its number of readings."""
    it = ObjectDatabase(path).known().objects[0]
    connection = sqlite3.connect(path)
    assert connection.execute("PRAGMA integrity_check").fetchone() == ("ok",)
    assert connection.execute("PRAGMA foreign_key_check").fetchall() == []
    connection.close()
    wanted = Statistics.of(it.readings)
    assert it.statistics.n == len(it.readings)
    np.testing.assert_allclose(it.statistics.mean, wanted.mean)
    np.testing.assert_allclose(it.statistics.covariance, wanted.covariance)
    return it.statistics.n


def started(script: str, path: Path) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-c", script, str(path)],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
    )  # fmt: skip


def killed(process: subprocess.Popen[str]) -> None:
    os.kill(process.pid, signal.SIGKILL)
    process.communicate()


@pytest.mark.slow
def test_a_writer_killed_within_a_lesson_leaves_the_lessons_before_it(tmp_path):
    path = tmp_path / "objects.sqlite"
    process = started(WRITER, path)
    assert process.stdout is not None
    lines = [process.stdout.readline().strip() for _ in range(3)]
    killed(process)
    assert lines == ["learned 0", "learned 1", "within"]
    # the journal of the unfinished lesson is there, and pages of it are in the file already
    assert path.with_name(path.name + "-journal").stat().st_size > 0
    assert whole(path) == 2 * LESSON
    ObjectDatabase(path).learn(SETTING, [lesson("x", (1, 1))])
    assert whole(path) == 2 * LESSON + 1


def test_a_writer_killed_at_any_moment_leaves_whole_lessons(tmp_path):
    path = tmp_path / "objects.sqlite"
    process = started(LOOP, path)
    assert process.stdout is not None
    for _ in range(5):
        process.stdout.readline()
    killed(process)
    n = whole(path)
    assert n >= 5 * LESSON
    assert n % LESSON == 0


@pytest.mark.slow
def test_readers_see_whole_lessons_while_a_writer_learns(tmp_path):
    path = tmp_path / "objects.sqlite"
    rng = np.random.default_rng(0)
    database = ObjectDatabase(path)
    learn = lambda: database.learn(  # noqa: E731
        SETTING, [Lesson("x", "", rng.normal(size=(LESSON, 2)), [""] * LESSON)]
    )
    learn()
    seen: list[int] = []
    troubles: list[BaseException] = []
    done = threading.Event()

    def read() -> None:
        try:
            while not done.is_set():
                it = ObjectDatabase(path).known().objects[0]
                assert len(it.readings) == it.statistics.n
                seen.append(it.statistics.n)
        except BaseException as error:
            troubles.append(error)

    readers = [threading.Thread(target=read) for _ in range(3)]
    for reader in readers:
        reader.start()
    for _ in range(12):
        learn()
    done.set()
    for reader in readers:
        reader.join()
    assert not troubles
    assert all(n % LESSON == 0 for n in seen)
    assert whole(path) == 13 * LESSON


def test_two_writers_that_make_the_database_at_once_both_succeed(tmp_path):
    path = tmp_path / "objects.sqlite"
    troubles: list[BaseException] = []

    def write(name: str) -> None:
        try:
            ObjectDatabase(path).learn(SETTING, [lesson(name, (1, 2), (3, 4))])
        except BaseException as error:
            troubles.append(error)

    writers = [threading.Thread(target=write, args=(f"object {i}",)) for i in range(6)]
    for writer in writers:
        writer.start()
    for writer in writers:
        writer.join()
    assert not troubles
    assert {s.name for s in ObjectDatabase(path).summaries()} == {f"object {i}" for i in range(6)}


def test_a_locked_database_says_so_after_the_wait(tmp_path):
    database = ObjectDatabase(tmp_path / "o.sqlite", timeout_s=0.05)
    database.learn(SETTING, [lesson("a", (1, 1))])
    other = sqlite3.connect(database.path, isolation_level=None)
    other.execute("BEGIN IMMEDIATE")
    assert database.summaries()[0].name == "a"  # who has not begun to commit hinders no reader
    with pytest.raises(DataError, match=r"o.sqlite: is locked by another program since 0.05 s"):
        database.learn(SETTING, [lesson("b", (1, 1))])
    other.execute("ROLLBACK")
    other.execute("BEGIN EXCLUSIVE")
    with pytest.raises(DataError, match="is locked by another program"):
        database.summaries()
    other.close()


def test_a_missing_database_is_an_error_with_the_nearest_name(tmp_path):
    ObjectDatabase(tmp_path / "objects.sqlite").learn(SETTING, [lesson("a", (1, 1))])
    with pytest.raises(DataError, match=r"no such object database; did you mean 'objects.sqlite'"):
        ObjectDatabase(tmp_path / "object.sqlite").summaries()
    with pytest.raises(DataError, match="is a folder, not an object database"):
        ObjectDatabase(tmp_path).summaries()
    with pytest.raises(DataError, match="there is no folder"):
        ObjectDatabase(tmp_path / "x" / "o.sqlite").learn(SETTING, [lesson("a", (1, 1))])
    assert not (tmp_path / "object.sqlite").exists()


def test_a_file_that_is_no_database_is_left_alone(tmp_path):
    path = tmp_path / "notes.txt"
    path.write_text("not a database at all, but long enough to be taken for one\n" * 20)
    for use in (
        ObjectDatabase(path).summaries,
        lambda: ObjectDatabase(path).learn(SETTING, [lesson("a", (1, 1))]),
    ):
        with pytest.raises(DataError, match="is no object database: not an SQLite file"):
            use()
    assert path.read_text().startswith("not a database")


def test_an_empty_file_holds_no_object_but_can_be_learned_into(tmp_path):
    path = tmp_path / "o.sqlite"
    path.touch()
    with pytest.raises(DataError, match="is empty: no object was learned yet"):
        ObjectDatabase(path).summaries()
    with pytest.raises(DataError, match="is empty: no object was learned yet"):
        ObjectDatabase(path).forget("a")
    ObjectDatabase(path).learn(SETTING, [lesson("a", (1, 1))])
    assert ObjectDatabase(path).summaries()[0].name == "a"


def test_another_programs_database_is_left_alone(tmp_path):
    path = tmp_path / "o.sqlite"
    with sqlite3.connect(path) as other:
        other.execute("CREATE TABLE songs (name TEXT)")
    other.close()
    with pytest.raises(DataError, match="is an SQLite database, but not one of objects"):
        ObjectDatabase(path).learn(SETTING, [lesson("a", (1, 1))])


def test_a_view_whose_rows_have_no_end_is_not_read(tmp_path):
    path = tmp_path / "o.sqlite"
    ObjectDatabase(path).learn(SETTING, [lesson("a", (1, 1))])
    with sqlite3.connect(path) as other:
        other.execute("CREATE VIEW more AS SELECT 1 AS id")
    other.close()
    with pytest.raises(DataError, match="holds a view 'more', which no database of objects has"):
        ObjectDatabase(path).known()


def test_another_schema_is_refused_and_says_what_to_do(tmp_path):
    path = tmp_path / "o.sqlite"
    ObjectDatabase(path).learn(SETTING, [lesson("a", (1, 1))])
    for version, todo in ((7, "update tactile-graph"), (1, "export it with the version that made")):
        with sqlite3.connect(path) as other:
            other.execute(f"PRAGMA user_version = {version}")
        other.close()
        with pytest.raises(DataError, match=f"has schema {version}, .* schema 2; {todo}"):
            ObjectDatabase(path).summaries()


def test_a_damaged_database_is_an_error_in_words(tmp_path):
    path = tmp_path / "o.sqlite"
    rows = np.ones((500, 2))
    ObjectDatabase(path).learn(SETTING, [Lesson("a", "", rows, ["somewhere"] * 500)])
    data = bytearray(path.read_bytes())
    data[4096:] = b"\xff" * (len(data) - 4096)
    path.write_bytes(data)
    with pytest.raises(DataError, match="is damaged"):
        ObjectDatabase(path).known()


# -- damage that SQLite does not see ---------------------------------------------------------


def learned(path: Path) -> Known:
    rng = np.random.default_rng(0)
    lessons = [Lesson(n, "disc", rng.normal(9.0, 1.0, (6, 2)), [f"{n} {i}" for i in range(6)])
               for n in ("cup", "Würfel", "key")]  # fmt: skip
    store = ObjectDatabase(path)
    store.learn(SETTING._replace(instrument=MAT), lessons)
    store.keep(Choice(Manner(0.1, 8, 16.0), 18, 17, 18, 12), store.known())
    return store.known()


def edit(path: Path, *statements: str) -> None:
    with sqlite3.connect(path) as other:
        other.execute("PRAGMA ignore_check_constraints = ON")
        for statement in statements:
            other.execute(statement)
    other.close()


@pytest.mark.parametrize(
    "statement",
    [
        "DELETE FROM means",
        "DELETE FROM means WHERE object_id = 2 AND feature_id = 1",
        "DELETE FROM scatters WHERE object_id = 1",
        "DELETE FROM reading_values WHERE reading_id = 3",
        "DELETE FROM readings WHERE id = 3",
        "DELETE FROM objects WHERE name = 'cup'",
        "DELETE FROM features WHERE id = 1",
        "DELETE FROM about",
        "DELETE FROM choice",
        "UPDATE choice SET variates = 4",
        "UPDATE reading_values SET value = value + 1e-12 WHERE reading_id = 7 AND feature_id = 0",
        "UPDATE reading_values SET value = 'x' WHERE reading_id = 7",
        "UPDATE means SET mean = x'00' WHERE feature_id = 1",
        "UPDATE scatters SET scatter = -scatter",
        "UPDATE objects SET name = 'cap' WHERE name = 'cup'",
        "UPDATE objects SET shape = ''",
        "UPDATE objects SET n_readings = 5",
        "UPDATE objects SET n_readings = 'many'",
        "UPDATE readings SET source = '' WHERE id = 1",
        "UPDATE readings SET object_id = 2 WHERE id = 1",
        "UPDATE features SET name = 'width' WHERE id = 1",
        "UPDATE features SET id = 2 WHERE id = 1",
        "UPDATE about SET quantity = 'raw'",
        "UPDATE about SET seal = 'x'",
        "UPDATE instrument SET pitch_x_cm = 1.31",
        "UPDATE instrument SET rows = 'many'",
        "DELETE FROM instrument",
    ],
)
def test_what_another_program_changed_is_refused_by_readers_and_writers(tmp_path, statement):
    path = tmp_path / "o.sqlite"
    learned(path)
    edit(path, statement)
    store = ObjectDatabase(path)
    before = path.read_bytes()
    for use in (
        store.known,
        store.summaries,
        lambda: store.learn(SETTING, [lesson("new", (1, 1))]),
        lambda: store.forget("Würfel"),
    ):
        with pytest.raises(DataError, match=r"o.sqlite: is damaged"):
            use()
    assert path.read_bytes() == before


@pytest.mark.parametrize(
    "statement",
    [
        "INSERT INTO reading_values VALUES (1, 7, 1.0)",
        "UPDATE reading_values SET value = 'x'",
        "UPDATE means SET mean = 9e999",
        "UPDATE objects SET n_readings = 0",
        "INSERT INTO about VALUES (2, '', '', '')",
        "INSERT INTO scatters VALUES (1, 1, 0, 1.0)",
        "UPDATE features SET id = -1",
        "UPDATE instrument SET pitch_y_cm = 0.0",
    ],
)
def test_the_schema_itself_refuses_what_cannot_be(tmp_path, statement):
    path = tmp_path / "o.sqlite"
    learned(path)
    with sqlite3.connect(path) as other:
        other.execute("PRAGMA foreign_keys = ON")
        with pytest.raises(sqlite3.IntegrityError):
            other.execute(statement)
    other.close()


@pytest.mark.slow
def test_bytes_changed_anywhere_give_the_same_or_a_refusal(tmp_path):
    path = tmp_path / "o.sqlite"
    known = learned(path)
    whole, rng, n_refused = path.read_bytes(), np.random.default_rng(4), 0
    for i in range(400):
        data = bytearray(whole)
        for at in rng.integers(0, 100 if i % 10 == 0 else len(data), rng.integers(1, 30)):
            data[at] = rng.integers(256)
        path.write_bytes(data if i % 5 else data[: rng.integers(1, len(data))])
        try:
            found = ObjectDatabase(path).known()
        except DataError:
            n_refused += 1
            continue
        assert found.same_readings(known)
        assert (found.choice, found.quantity, found.pipeline) == (known.choice, "gram", "features")
        for a, b in zip(found.objects, known.objects, strict=True):
            assert (a.name, a.shape, a.sources) == (b.name, b.shape, b.sources)
            np.testing.assert_array_equal(a.statistics.scatter, b.statistics.scatter)
    assert 100 < n_refused < 400


def test_a_name_that_is_no_text_any_more_is_told(tmp_path):
    path = tmp_path / "o.sqlite"
    learned(path)
    data = path.read_bytes()
    path.write_bytes(data.replace(b"reading_values", b"reading\xff\xfevalue"))
    with pytest.raises(DataError, match="is damaged"):
        ObjectDatabase(path).known()


def test_a_choice_lives_until_the_objects_change(tmp_path):
    path = tmp_path / "o.sqlite"
    known = learned(path)
    assert known.choice == Choice(Manner(0.1, 8, 16.0), 18, 17, 18, 12)
    assert known.chosen(["weight"]).choice is None
    store = ObjectDatabase(path)
    store.learn(SETTING, [lesson("new", (1, 1))])
    assert store.known().choice is None
    store.keep(known.choice, known)  # made for the objects as they were
    assert store.known().choice is None
    store.keep(known.choice, store.known())
    store.forget("new")
    assert store.known().choice is None
