from __future__ import annotations

import numpy as np
import pytest
import yaml

from helpers_classifiers import MAT, SETTING, export_of, three_objects
from tactile_graph.errors import DataError
from tactile_graph_classifiers.database.opening import SAMPLE, load_known
from tactile_graph_classifiers.database.rows import Lesson
from tactile_graph_classifiers.database.store import ObjectDatabase
from tactile_graph_classifiers.database.text import from_data, from_text, read_export, to_text


def filled(path):
    database = ObjectDatabase(path)
    lessons = [Lesson(n, "disc", r, [f"{n}: {i}" for i in range(25)])
               for n, r in three_objects().items()]  # fmt: skip
    setting = SETTING._replace(instrument=MAT)
    database.learn(setting, [*lessons, Lesson("ä: 'ö'", "", np.array([[1e20, -1e-300]]), ["x"])])
    return database


def test_export_and_import_keep_every_digit(tmp_path):
    known = filled(tmp_path / "a.sqlite").known()
    other = ObjectDatabase(tmp_path / "b.sqlite")
    other.learn(*from_text(to_text(known, "a remark"), "text"), new=True)
    again = other.known()
    assert (again.names, again.features, again.quantity, again.pipeline) == (
        known.names, known.features, known.quantity, known.pipeline
    )  # fmt: skip
    assert again.instrument == MAT
    for a, b in zip(again.objects, known.objects, strict=True):
        np.testing.assert_array_equal(a.readings, b.readings)
        assert (a.shape, a.sources) == (b.shape, b.sources)
    assert to_text(again) == to_text(known)


@pytest.mark.parametrize("word", ["no", "y", "~", "1e3", "0o17", "1:30", "2026-01-01"])
def test_words_that_readers_of_yaml_take_for_others_are_in_quotes(tmp_path, word):
    database = ObjectDatabase(tmp_path / "a.sqlite")
    rows = np.array([[1.0, 1e-9, 1e20]])[:, : len(SETTING.features)]
    database.learn(SETTING, [Lesson(word, "disc", rows, [word])])
    text = to_text(database.known())
    assert f"name: '{word}'\n" in text
    assert f"['{word}']\n" in text
    (lesson,) = from_text(text, "text")[1]
    assert (lesson.name, list(lesson.sources)) == (word, [word])
    np.testing.assert_array_equal(lesson.readings, rows)


def test_a_classifier_reads_database_export_and_data_alike(tmp_path):
    database = filled(tmp_path / "a.sqlite")
    export = tmp_path / "a.yaml"
    export.write_text(to_text(database.known()), encoding="utf-8")
    found = [load_known(p, ["weight"]) for p in (database.path, export)]
    data = load_known(yaml.safe_load(export.read_text(encoding="utf-8")), ["weight"])
    for known in (*found, data):
        np.testing.assert_allclose(known.means, found[0].means)
        np.testing.assert_allclose(known.covariances, found[0].covariances)
        assert known.features == ("weight",)


def test_the_sample_holds_25_readings_of_each_object_of_the_thesis():
    known = load_known(None, ["weight", "area_cm2", "holes"])
    assert [(o.name, o.shape) for o in known.objects] == [
        ("Disc I", "disc"), ("Disc II", "disc"), ("PENTAGON", "polygon"),
        ("Disc III", "disc"), ("Disc IV", "disc"),
        ("RECTANGLE I", "rectangle"), ("RECTANGLE II", "rectangle"),
    ]  # fmt: skip
    assert set(known.counts) == {25.0}
    assert known.quantity == "gram"
    assert SAMPLE.stat().st_size < 60_000


def change(**more):
    return {**export_of(three_objects()), **more}


@pytest.mark.parametrize(
    ("data", "message"),
    [
        ([1], "is no export of an object database"),
        ({"format": "songs"}, "is no export of an object database"),
        (change(version=2), "is an export of version 2, version 1 can be read"),
        (change(colour=1), "unknown key 'colour'; allowed: about"),
        (change(feature=[]), "unknown key 'feature'; did you mean 'features'"),
        (change(features=[]), "features: must be a list of different names"),
        (change(features=["a", "a"]), "features: must be a list of different names"),
        (change(features="ab"), "features: must be a list of different names, got 'ab'"),
        (change(instrument=3), "instrument: must be whole numbers rows and columns, and"),
        (change(instrument={**MAT._asdict(), "rows": 0}), "all above 0, got {'rows': 0"),
        (change(instrument={**MAT._asdict(), "rows": 1.5}), "whole numbers rows"),
        (change(objects={}), "objects: must be a list, got {}"),
        (change(objects=[1]), "object 1: must be a mapping with a name, got 1"),
        (change(objects=[{"name": "a", "reading": []}]), "object 'a': unknown key 'reading'; did"),
        (change(objects=[{"name": "a"}]), "object 'a': readings must be one or more rows of 2"),
        (change(objects=[{"name": "a", "readings": []}]), "must be one or more rows of 2"),
        (change(objects=[{"name": "a", "readings": [[1, 10**400]]}]), "rows of 2 finite numbers"),
        (change(objects=[{"name": "a", "readings": [[1]]}]), "rows of 2 finite numbers"),
        (change(objects=[{"name": "a", "readings": [[1, True]]}]), "rows of 2 finite numbers"),
        (change(objects=[{"name": "a", "readings": [[1, float("nan")]]}]), "rows of 2 finite"),
        (change(objects=[{"name": "a", "readings": [[1, 2]], "sources": []},
                         {"name": "a", "readings": [[1, 2]]}]), "two objects are named 'a'"),
        (change(objects=[{"name": "a", "readings": [[1, 2]], "sources": [1]}]), "sources must be"),
        (change(objects=[{"name": "a", "readings": [[1, 2]], "shape": 1}]), "shape must be a text"),
    ],
)  # fmt: skip
def test_what_is_no_export_is_refused_in_words(data, message):
    with pytest.raises(DataError, match=r"^x\.yaml: ") as caught:
        from_data(data, "x.yaml")
    assert message in str(caught.value)


def test_what_is_no_yaml_is_refused_with_its_place(tmp_path):
    with pytest.raises(DataError, match=r"x.yaml:\d+:\d+: is no YAML"):
        from_text("format: tactile-graph objects\nb: [", "x.yaml")
    for value in ("2026-13-45", "[" * 5000, "1" + ":59" * 200 + ".5", "9" * 1500, "!!int x"):
        with pytest.raises(DataError, match=r"x\.yaml.*: is no YAML"):
            from_text(f"format: tactile-graph objects\na: {value}", "x.yaml")


def test_yaml_that_does_not_say_what_it_is_is_not_read(monkeypatch):
    monkeypatch.setattr("yaml.load", None)
    with pytest.raises(DataError, match="is no export of an object database"):
        from_text("[" + "1," * 100_000, "x.yaml")


def test_what_cannot_be_read_is_refused_with_its_name(tmp_path):
    path = tmp_path / "x.yaml"
    with pytest.raises(DataError, match="cannot be read: No such file"):
        read_export(path)
    path.write_bytes(b"\xff\x00\x81")
    with pytest.raises(DataError, match="is no text file"):
        read_export(path)
