from __future__ import annotations

import sqlite3
from itertools import permutations

import numpy as np
import pytest

from helpers_classifiers import MAT, PAIR, SETTING, lesson, three_objects
from tactile_graph.errors import DataError, UsageError
from tactile_graph_classifiers.database import store
from tactile_graph_classifiers.database.instrument import Instrument
from tactile_graph_classifiers.database.rows import Lesson, Setting
from tactile_graph_classifiers.database.statistics import Statistics
from tactile_graph_classifiers.database.store import ObjectDatabase


@pytest.fixture
def database(tmp_path):
    return ObjectDatabase(tmp_path / "objects.sqlite", timeout_s=0.1)


def test_what_was_learned_is_known_with_readings_sources_and_shape(database):
    database.learn(
        SETTING, [lesson("a", (1.0, 2.0), (3.0, 5.0), shape="disc"), lesson("b", (9, 9))]
    )
    known = database.known()
    assert (known.features, known.quantity, known.pipeline) == (PAIR, "gram", "features")
    assert known.names == ("a", "b")
    assert known.objects[0].readings.tolist() == [[1.0, 2.0], [3.0, 5.0]]
    assert known.objects[0].sources == ("a 0", "a 1")
    assert known.objects[0].shape == "disc"
    assert known.counts.tolist() == [2.0, 1.0]


def test_statistics_kept_as_readings_come_are_those_of_all_readings_at_once(database):
    rows = three_objects()["heavy"]
    for part in np.array_split(rows, [1, 2, 9]):
        database.learn(SETTING, [Lesson("x", "", part, [""] * len(part))])
    it = database.known().objects[0]
    wanted = Statistics.of(rows)
    np.testing.assert_allclose(it.statistics.mean, wanted.mean)
    np.testing.assert_allclose(it.statistics.covariance, wanted.covariance)
    np.testing.assert_array_equal(it.readings, rows)
    assert it.statistics.n == 25


def test_every_order_of_learning_gives_the_same_statistics(tmp_path):
    rows = [(1.0, 5.0), (2.0, -1.0), (4.0, 0.5)]
    for k, order in enumerate(permutations(range(3))):
        database = ObjectDatabase(tmp_path / f"{k}.sqlite")
        for i in order:
            database.learn(SETTING, [lesson("x", rows[i])])
        found = database.known().objects[0].statistics
        np.testing.assert_allclose(found.covariance, np.cov(np.array(rows).T))


def test_more_readings_keep_the_shape_unless_another_is_given(database):
    database.learn(SETTING, [lesson("a", (1, 1), shape="disc")])
    database.learn(SETTING, [lesson("a", (1, 1))])
    assert [(s.name, s.shape, s.n_readings) for s in database.summaries()] == [("a", "disc", 2)]
    database.learn(SETTING, [lesson("a", (1, 1), shape="polygon")])
    assert database.summaries()[0].shape == "polygon"


def test_a_forgotten_object_leaves_no_row_behind(database):
    database.learn(SETTING, [lesson("a", (1, 1), (2, 2)), lesson("b", (3, 3))])
    assert database.forget("a") == 2
    assert database.known().names == ("b",)
    with sqlite3.connect(database.path) as connection:
        counts = {
            table: connection.execute(f"SELECT count(*) FROM {table}").fetchone()[0]
            for table in ("objects", "readings", "reading_values", "means", "scatters")
        }
    connection.close()
    assert counts == {
        "objects": 1, "readings": 1, "reading_values": 2, "means": 2, "scatters": 3
    }  # fmt: skip


def test_forgetting_what_is_not_there_names_the_nearest(database):
    database.learn(SETTING, [lesson("Disc I", (1, 1))])
    with pytest.raises(UsageError, match="no object named 'Disk I'; did you mean 'Disc I'"):
        database.forget("Disk I")
    with pytest.raises(UsageError, match="no object named 'zzz'; there are: Disc I"):
        database.forget("zzz")


def test_the_readings_of_one_recording_are_forgotten(database):
    database.learn(SETTING, [lesson("a", (1, 1), (2, 2), (4, 3))])
    rows = np.array([(9.0, 9.0), (8.0, 8.0)])
    database.learn(
        SETTING, [Lesson("a", "", rows, [f"x/a.npz, x/b.npz {n}.npz frame 0" for n in "ab"])]
    )
    with pytest.raises(UsageError, match=r"of 'x/c\.npz'; they are of: a 0, a 1"):
        database.forget("a", "x/c.npz")
    with pytest.raises(UsageError, match=r"no reading of 'a' is of 'b\.npz'"):
        database.forget("a", "b.npz")
    assert database.forget("a", "x/b.npz") == 1
    it = database.known().objects[0]
    np.testing.assert_array_equal(it.readings, [(1, 1), (2, 2), (4, 3), (9, 9)])
    np.testing.assert_allclose(it.statistics.mean, it.readings.mean(axis=0))
    assert it.sources == ("a 0", "a 1", "a 2", "x/a.npz, x/b.npz a.npz frame 0")


def test_names_that_look_the_same_are_one_object(database):
    composed, decomposed = "M\u00fctze", "Mu\u0308tze"
    database.learn(SETTING, [lesson(decomposed, (1, 1))])
    database.learn(SETTING, [lesson(composed, (2, 2))])
    assert database.known().names == (composed,)
    assert database.forget(decomposed) == 2


def test_an_object_kept_with_letters_in_parts_is_found_and_learned_more_of(database, monkeypatch):
    composed, decomposed = "M\u00fctze", "Mu\u0308tze"
    with monkeypatch.context() as earlier:
        earlier.setattr(store, "plain_name", lambda name: name)
        database.learn(SETTING, [lesson(decomposed, (1, 1))])
    database.learn(SETTING, [lesson(composed, (2, 2))])
    assert [(s.name, s.n_readings) for s in database.summaries()] == [(decomposed, 2)]
    assert database.rename(composed, composed) == 2
    assert database.known().names == (composed,)


@pytest.mark.parametrize("name", ["", "  ", "unknown", "a\x07b"])
def test_a_name_must_be_printable_and_not_unknown(database, name):
    with pytest.raises(UsageError, match="an object's name must be printable text other than"):
        database.learn(SETTING, [lesson(name, (1, 1))])


def test_other_features_or_another_unit_go_into_a_database_of_their_own(database):
    database.learn(SETTING, [lesson("a", (1, 1))])
    with pytest.raises(
        UsageError, match=r"readings are in gram, the new ones in volt; .*\(here fe"
    ):
        database.learn(Setting(PAIR, "volt"), [lesson("a", (1, 1))])
    with pytest.raises(UsageError, match="the new readings lack area_cm2 and have holes besides"):
        database.learn(Setting(("weight", "holes"), "gram"), [lesson("a", (1, 1))])
    with pytest.raises(UsageError, match="hold the features in another order"):
        database.learn(Setting(PAIR[::-1], "gram"), [lesson("a", (1, 1))])
    assert database.summaries()[0].n_readings == 1


def test_readings_of_another_pitch_go_into_a_database_of_their_own(database):
    database.learn(SETTING, [lesson("a", (1, 1))])  # by an earlier version, which did not say
    assert database.known().instrument is None
    database.learn(SETTING._replace(instrument=MAT), [lesson("a", (1, 1))])
    database.learn(SETTING._replace(instrument=MAT._replace(rows=8)), [lesson("a", (1, 1))])
    database.learn(SETTING, [lesson("a", (1, 1))])
    assert database.known().instrument == database.known().chosen(["weight"]).instrument == MAT
    fine = SETTING._replace(instrument=MAT._replace(pitch_x_cm=0.5))
    with pytest.raises(
        UsageError,
        match=r"are of 16 x 16 elements 1.3 x 1.3 cm apart, the new ones of .* 0.5 x 1.3 cm apart",
    ):
        database.learn(fine, [lesson("b", (1, 1))])
    assert database.summaries()[0].n_readings == 4


@pytest.mark.parametrize("number", [int, np.float64, np.float32])
def test_pitches_of_any_kind_of_number_are_sealed_as_they_are_read(database, number):
    instrument = Instrument(16, 16, number(2), number(2))
    database.learn(SETTING._replace(instrument=instrument), [lesson("a", (1, 1))])
    assert database.known().instrument == Instrument(16, 16, 2.0, 2.0)


def test_all_lessons_are_learned_or_none(database):
    database.learn(SETTING, [lesson("a", (1, 1))])
    with pytest.raises(UsageError, match="there already: a; forget them first"):
        database.learn(SETTING, [lesson("b", (1, 1)), lesson("a", (2, 2))], new=True)
    with pytest.raises(DataError, match="a reading holds a value that is no finite number"):
        database.learn(SETTING, [lesson("b", (1, 1)), lesson("c", (np.nan, 2))])
    with pytest.raises(UsageError, match=r"readings must be of shape \(n, 2\), got \(1, 3\)"):
        database.learn(SETTING, [lesson("b", (1, 1, 1))])
    with pytest.raises(UsageError, match="b: there is no reading to learn"):
        database.learn(SETTING, [Lesson("b", "", np.ones((0, 2)), [])])
    with pytest.raises(UsageError, match="1 readings but 0 sources"):
        database.learn(SETTING, [Lesson("b", "", np.ones((1, 2)), [])])
    assert [s.name for s in database.summaries()] == ["a"]
