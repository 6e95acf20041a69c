"""Presses and reliefs in a database: kept to the last bit, refused when damaged or out of date."""

from __future__ import annotations

import sqlite3
from pathlib import Path

import numpy as np
import pytest

from helpers_classifiers import SETTING, lesson
from tactile_graph.errors import DataError
from tactile_graph_classifiers.database.opening import load_reliefs
from tactile_graph_classifiers.database.relief_rows import Kept, Press
from tactile_graph_classifiers.database.store import ObjectDatabase

ROWS = ((500.0, 40.0), (510.0, 41.0), (495.0, 39.0))


def arrays() -> Kept:
    rng = np.random.default_rng(0)
    pad = {
        "law": np.array([[0.5, 0.9, 0.01]]),
        "gains": rng.uniform(0.9, 1.1, (4, 6)),
        "doubts": rng.uniform(0.0, 0.01, (4, 6)),
        "variances": np.full((1, 3), 1e-4),
        "numbers": np.array([[255.0, 0.99, 1e-3, 0.5]]),
    }
    one = {"depth": rng.normal(size=(7, 7)), "picture": rng.uniform(size=(7, 7)),
           "numbers": np.array([[0.4, 0.01, 0.1, 0.2, 50.0]]),
           "left_out": np.array([[40.0, np.nan, 61.0]])}  # fmt: skip
    return Kept(pad, {"cup": one, "ball": {**one, "depth": one["depth"] + 1.0}})


@pytest.fixture
def store(tmp_path: Path) -> ObjectDatabase:
    made = ObjectDatabase(tmp_path / "objects.sqlite")
    for name in ("cup", "ball"):
        presses = [Press(np.full((4, 6), float(k)), 0.5) for k in range(3)]
        presses[1].values[2, 3] = np.nan
        made.learn(SETTING, [lesson(name, *ROWS)], presses={name: presses})
    made.keep_reliefs(arrays(), made.known())
    return made


def changed(store: ObjectDatabase, statement: str, *values: object) -> None:
    connection = sqlite3.connect(store.path)
    with connection:
        connection.execute("PRAGMA ignore_check_constraints = ON")
        connection.execute(statement, values)
    connection.close()


def test_presses_come_back_as_they_were(store):
    known, presses = store.presses()
    assert known.names == ("cup", "ball")
    for some in presses:
        assert [one.pitch_cm for one in some] == [0.5] * 3
        np.testing.assert_array_equal(some[2].values, np.full((4, 6), 2.0))
        assert np.isnan(some[1].values[2, 3])


def test_a_reading_learned_without_its_press_has_none(store):
    store.learn(SETTING, [lesson("cup", (505.0, 40.0))])
    assert [one is None for one in store.presses()[1][0]] == [False, False, False, True]


def test_a_database_without_presses_has_none_of_any_reading(tmp_path):
    plain = ObjectDatabase(tmp_path / "plain.sqlite")
    plain.learn(SETTING, [lesson("cup", *ROWS)])
    assert plain.presses()[1] == [[None] * 3]
    assert plain.reliefs()[2] == ["cup"]


def test_reliefs_come_back_as_they_were(store):
    _, kept, lacking = store.reliefs()
    wanted = arrays()
    assert lacking == []
    assert list(kept.objects) == ["cup", "ball"]
    for name, values in wanted.pad.items():
        np.testing.assert_array_equal(kept.pad[name], values)
    for owner, own in wanted.objects.items():
        for name, values in own.items():
            np.testing.assert_array_equal(kept.objects[owner][name], values)


def test_a_relief_is_out_of_date_when_readings_are_added(store):
    store.learn(SETTING, [lesson("cup", (505.0, 40.0))])
    assert store.reliefs()[2] == ["cup"]
    with pytest.raises(DataError, match="cup: no relief was learned of the present readings"):
        load_reliefs(store.path)


def test_the_others_keep_their_reliefs_when_one_is_forgotten(store):
    store.forget("cup")
    known, kept = load_reliefs(store.path)
    assert known.names == tuple(kept.objects) == ("ball",)
    assert len(store.presses()[1]) == 1


def test_presses_and_reliefs_go_with_an_object_that_is_renamed(store):
    assert store.rename("cup", "mug") == 3
    known, kept = load_reliefs(store.path)
    assert known.names == tuple(kept.objects) == ("mug", "ball")
    np.testing.assert_array_equal(kept.objects["mug"]["depth"], arrays().objects["cup"]["depth"])
    assert [one.pitch_cm for one in store.presses()[1][0]] == [0.5] * 3
    store.learn(SETTING, [lesson("mug", (505.0, 40.0))])  # without its press
    assert store.rename("mug", "ball", merge=True) == 7
    ((*presses, without),) = store.presses()[1]
    assert [one.values[0, 0] for one in presses] == [0.0, 1.0, 2.0] * 2
    assert without is None
    assert store.reliefs()[2] == ["ball"]


def test_reliefs_of_objects_that_have_changed_meanwhile_are_not_kept(store):
    before = store.known()
    store.learn(SETTING, [lesson("cup", (505.0, 40.0))])
    with pytest.raises(DataError, match="was changed while reliefs were learned"):
        store.keep_reliefs(arrays(), before)


@pytest.mark.parametrize(
    "statement",
    [
        "UPDATE relief_arrays SET data = zeroblob(length(data)) WHERE name = 'depth'",
        "UPDATE relief_arrays SET rows = 49, columns = 1 WHERE name = 'depth'",
        "UPDATE relief_arrays SET data = 'text' WHERE name = 'picture'",
        "DELETE FROM relief_arrays WHERE name = 'numbers'",
        "UPDATE pad_arrays SET data = zeroblob(24) WHERE name = 'law'",
        "DELETE FROM pad_arrays WHERE name = 'gains'",
        "UPDATE pad_arrays SET name = 'other' WHERE name = 'gains'",
        "UPDATE pad_arrays SET rows = 2, columns = 2 WHERE name = 'gains'",
    ],
)
def test_a_relief_that_was_damaged_is_refused(store, statement):
    changed(store, statement)
    with pytest.raises(DataError, match="is damaged, or was edited by another program"):
        store.reliefs()


def test_a_press_that_was_damaged_is_refused(store):
    changed(store, "UPDATE presses SET data = zeroblob(192) WHERE reading_id = 3")
    with pytest.raises(DataError, match="a press of 'cup' is not what was learned"):
        store.presses()


@pytest.mark.parametrize(("name", "shape"), [("depth", (6, 6)), ("depth", (7, 5)),
                                             ("picture", (5, 5)), ("numbers", (1, 4))])  # fmt: skip
def test_a_relief_of_another_shape_is_refused(store, name, shape):
    kept = arrays()
    kept.objects["cup"][name] = np.ones(shape)
    store.keep_reliefs(kept, store.known())
    with pytest.raises(DataError, match="arrays of the relief of 'cup' are missing or of another"):
        store.reliefs()


def test_a_relief_with_a_number_that_is_none_is_refused(store):
    kept = arrays()
    kept.objects["cup"]["depth"][0, 0] = np.inf
    store.keep_reliefs(kept, store.known())
    with pytest.raises(DataError, match="is damaged"):
        store.reliefs()


def test_an_export_holds_no_reliefs(tmp_path):
    export = tmp_path / "objects.yaml"
    export.write_text("format: tactile-graph objects\n")
    with pytest.raises(DataError, match="is an export, which holds no reliefs"):
        load_reliefs(export)


@pytest.mark.slow
def test_a_flipped_byte_is_refused_or_changes_nothing(store, tmp_path):
    rng = np.random.default_rng(0)
    whole, wanted = store.path.read_bytes(), store.reliefs()[1]
    n_refused = 0
    for at in rng.integers(100, len(whole), 150):
        bad = bytearray(whole)
        bad[at] ^= 1 << int(rng.integers(8))
        path = tmp_path / "bad.sqlite"
        path.write_bytes(bad)
        try:
            _, kept, lacking = ObjectDatabase(path).reliefs()
        except DataError:
            n_refused += 1
            continue
        assert lacking == []
        for name, values in wanted.pad.items():
            np.testing.assert_array_equal(kept.pad[name], values)
        for owner, own in wanted.objects.items():
            for name, values in own.items():
                np.testing.assert_array_equal(kept.objects[owner][name], values)
    assert n_refused > 5
