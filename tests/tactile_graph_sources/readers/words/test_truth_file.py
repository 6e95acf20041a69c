"""Truth from a file of its own: which objects lie in which frames."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator
from contextlib import closing
from itertools import islice
from pathlib import Path

import numpy as np
import pytest

from tactile_graph import Frame
from tactile_graph.errors import DataError, UsageError
from tactile_graph.wires import Circle, Ellipse, Rectangle, TrueObject
from tactile_graph_sources.readers.words.truth import truth_to_json
from tactile_graph_sources.readers.words.truth_file import with_truth


def frames(n: int = 4) -> Iterator[Frame]:
    return (Frame.of(np.zeros((2, 2)), index=k) for k in range(n))


CIRCLE = "frames,kind,x_cm,y_cm,radius_cm"
TABLE = """frames;kind;x_cm;y_cm;radius_cm;length_cm;breadth_cm;angle_deg;weight_g;name
0-1;circle;1,5;2;0.5;;;;200;cup
1;rectangle;3;4;;2;1;90;;
2;none;;;;;;;;
"""


def test_a_table_says_what_lies_in_which_frames(tmp_path: Path) -> None:
    path = tmp_path / "truth.csv"
    path.write_text(TABLE)
    cup = TrueObject(Circle(1.5, 2.0, 0.5), 200.0, "cup")
    bar = TrueObject(Rectangle(3.0, 4.0, 2.0, 1.0, math.pi / 2))
    assert [f.truth for f in with_truth(frames(), path)] == [(cup,), (cup, bar), (), None]


def test_empty_fields_at_the_end_of_a_line_are_none(tmp_path: Path) -> None:
    path = tmp_path / "truth.csv"
    path.write_text(f"{CIRCLE}\n0-1,circle,1,2,3,,,\n2,none\n3,circle,1,2,3\n2-2,none\n")
    cup = TrueObject(Circle(1.0, 2.0, 3.0))
    assert [f.truth for f in with_truth(frames(), path)] == [(cup,), (cup,), (), (cup,)]


def test_a_rectangle_is_the_same_whichever_side_comes_first(tmp_path: Path) -> None:
    table, listed = tmp_path / "truth.csv", tmp_path / "truth.json"
    table.write_text(
        "frames,kind,x_cm,y_cm,length_cm,breadth_cm,angle_deg\n"
        "0,rectangle,1,2,6,2,30\n1,rectangle,1,2,2,6,120\n"
    )
    bar = {"kind": "rectangle", "x_cm": 1, "y_cm": 2, "length_cm": 2, "breadth_cm": 6}
    listed.write_text(json.dumps([[{**bar, "angle_rad": math.radians(120)}]]))
    found = [f.truth for f in with_truth(frames(2), table)]
    found += [f.truth for f in with_truth(frames(1), listed)]
    shapes = [truth[0].shape for truth in found if truth]
    assert all(isinstance(s, Rectangle) and s.length_cm == 6.0 for s in shapes)
    assert [s.angle_deg for s in shapes if isinstance(s, Rectangle)] == pytest.approx([30.0] * 3)


def test_objects_wholly_off_the_pad_are_counted_the_first_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    table, listed = tmp_path / "truth.csv", tmp_path / "truth.json"
    table.write_text(f"{CIRCLE}\n0-1,circle,1,2,3\n2,circle,12,8,3\n0-3,circle,12,15,3\n")
    off = TrueObject(Circle(-4.0, 1.0, 3.0))
    listed.write_text(truth_to_json([None, (TrueObject(Circle(1.0, 1.0, 1.0)), off), (off,), ()]))
    list(with_truth(frames(), table))
    with closing(with_truth(frames(), listed)) as known:  # not all are taken
        list(islice(known, 3))
    of_table, of_list = capsys.readouterr().err.splitlines()
    assert "truth.csv: 2 of 3 objects lie wholly off the pad of 2 by 2 cm, first" in of_table
    assert "that of line 3 at x 12, y 8 cm; lengths are cm from the pad's" in of_table
    assert of_table.endswith("y down: are these mm?")
    assert "first that of frame 1, object 1 at x -4, y 1 cm" in of_list
    assert of_list.endswith("y down")
    table.write_text(f"{CIRCLE}\nall,circle,3,1,1.5\n")
    list(with_truth(frames(), table))
    assert not capsys.readouterr().err


def test_an_object_given_twice_counts_once_and_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    table, listed = tmp_path / "truth.csv", tmp_path / "truth.json"
    table.write_text(f"{CIRCLE},name\n0-1,circle,1,2,3,\nall,circle,1,2,3\n1,circle,1,2,3,lid\n")
    cup, lid = TrueObject(Circle(1.0, 2.0, 3.0)), TrueObject(Circle(1.0, 2.0, 3.0), None, "lid")
    assert [f.truth for f in with_truth(frames(3), table)] == [(cup,), (cup, lid), (cup,)]
    assert "truth.csv: 1 object is another one again, of the same" in (err := readerr(capsys))
    assert err.endswith("first that of line 3, which is that of line 2")
    listed.write_text(truth_to_json([(cup, lid, cup), (cup, cup), None]))
    assert [f.truth for f in with_truth(frames(3), listed)] == [(cup, lid), (cup,), None]
    assert "2 objects are others again" in (err := readerr(capsys))
    assert err.endswith("that of frame 0, object 2, which is that of frame 0, object 0")


def test_objects_of_other_weights_that_are_stacked_all_count(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "truth.csv"
    path.write_text(f"{CIRCLE},weight_g\nall,circle,1,2,3,100\nall,circle,1,2,3,200\n")
    (frame,) = with_truth(frames(1), path)
    assert [o.weight_g for o in frame.truth or ()] == [100.0, 200.0]
    assert not capsys.readouterr().err


def readerr(capsys: pytest.CaptureFixture[str]) -> str:
    return capsys.readouterr().err.rstrip()


def test_all_is_every_frame(tmp_path: Path) -> None:
    path = tmp_path / "truth.csv"
    path.write_text(
        "frames,kind,x_cm,y_cm,semi_major_cm,semi_minor_cm,angle_deg\nall,ellipse,1,2,3,2,0\n"
    )
    egg = TrueObject(Ellipse(1.0, 2.0, 3.0, 2.0, 0.0))
    assert {f.truth for f in with_truth(frames(), path)} == {(egg,)}


def test_a_list_is_one_entry_a_frame(tmp_path: Path) -> None:
    truths = [None, (), (TrueObject(Circle(1.0, 2.0, 3.0)),), None]
    path = tmp_path / "truth.json"
    path.write_text(truth_to_json(truths))
    assert [f.truth for f in with_truth(frames(), path)] == truths
    for n in (3, 5):
        with pytest.raises(DataError, match="holds the truth of 4 frames, there are"):
            list(with_truth(frames(n), path))


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("frame,kind\n", "1: no column 'frame'; known: .*did you mean 'frames'"),
        ("frames,name\n", "a header with 'frames' and 'kind' is needed"),
        ("frames,kind\n3,cirle\n", "truth.csv:2: unknown kind 'cirle', .*did you mean 'circle'"),
        ("frames,kind,x_cm,y_cm,radius_cm\n0,circle,1,2,-3\n", "radius_cm: must be a number > 0"),
        ("frames,kind,x_cm,y_cm,radius_cm\n0,circle,,2,3\n", "x_cm: must be a number, got ''"),
        ("frames,kind\n3-1,none\n", "must be such as 7, 10-25 or all, got '3-1'"),
        ("frames,kind\n9,none\n", "speaks of frame 9, the last one is 3"),
        (
            f"{CIRCLE}\n0,circle,12,65,10,94,6,8\n",
            "truth.csv:2: 8 fields, the header names 5; deci",
        ),
        (
            f"{CIRCLE},length_cm\n0,circle,12,65,10,94\n",
            "2: kind 'circle' has no length_cm, got '94'",
        ),
        (f"{CIRCLE}\n0,none,12\n", "truth.csv:2: kind 'none' has no x_cm, got '12'; leave it out"),
        (f"{CIRCLE},x_cm\n0,circle,1,2,3,4\n", "1: columns 3 and 6 are both 'x_cm'; keep one of"),
        (
            f"{CIRCLE}\n0-2,circle,1,2,3\n2,none\n",
            "3: nothing does in frame 2, and line 2 says the",
        ),
        (f"{CIRCLE}\nall,none\n1,circle,1,2,3\n", "3: an object lies there in frame 1, and line 2"),
        (f"{CIRCLE}\n", "truth.csv: a header and no line below it"),
        (
            "frames,kind\n1234567890123,none\n",
            "must be such as 7, 10-25 or all, got '1234567890123'",
        ),
    ],
)
def test_what_cannot_be_true_is_named(text: str, what: str, tmp_path: Path) -> None:
    path = tmp_path / "truth.csv"
    path.write_text(text)
    with pytest.raises(DataError, match=what):
        list(with_truth(frames(), path))


GOOD = {"kind": "circle", "x_cm": 9, "y_cm": 11, "radius_cm": 6}


@pytest.mark.parametrize(
    ("listed", "what"),
    [
        (
            {"0": {"x": 9}},
            'must be a list with an entry for each frame, got {"0": {"x": 9}}; such as '
            '[[{"kind": "circle", "x_cm": 9, "y_cm": 11, "radius_cm": 6}], [], null]',
        ),
        ([None, GOOD], 'frame 1: must be null or a list of objects, got {"kind": "circle", "x'),
        ([[GOOD, "cup"]], 'frame 0, object 1: must be an object, got "cup"; such as [[{"kind"'),
        (
            [[{"shape": "circle", "x_cm": 9, "y_cm": 11, "radius_cm": 6}]],
            "frame 0, object 0: has no 'kind' (circle, ellipse, polygon, rectangle); 'shape' is",
        ),
        (
            [[{**GOOD, "kind": "cirle"}]],
            "kind \"cirle\", known: circle, ellipse, polygon, rectangle; did you mean 'circle'?",
        ),
        ([[{**GOOD, "kind": 3}]], "unknown kind 3, known: circle"),
        (
            [[{"kind": "circle", "x_cm": 9, "y_cm": 11, "radius": 6}]],
            "unknown key 'radius'; a circle has kind, x_cm, y_cm, radius_cm, weight_g, name; "
            "did you mean 'radius_cm'?",
        ),
        ([[{"kind": "circle", "x_cm": 9, "y_cm": 1}]], "frame 0, object 0: has no 'radius_cm'"),
        ([[{**GOOD, "weight": 9}]], "weight_g, name; did you mean 'weight_g'?"),
        ([[{**GOOD, "x_cm": "9,5"}]], 'frame 0, object 0: x_cm: must be a number, got "9,5"'),
        ([[{**GOOD, "radius_cm": -6}]], "radius_cm: must be a number > 0, got -6"),
        ([[{**GOOD, "x_cm": math.nan}]], "x_cm: must be a number, got NaN"),
        ([[{**GOOD, "x_cm": 10**400}]], "x_cm: must be a number, got 1000000000"),
        ([[{"kind": "polygon", "xy_cm": [1, 2]}]], "xy_cm: must be corners, a list of pairs"),
    ],
)
def test_json_that_is_no_truth_says_where_what_and_what_is_right(
    listed: object, what: str, tmp_path: Path
) -> None:
    path = tmp_path / "truth.json"
    path.write_text(json.dumps(listed))
    with pytest.raises(DataError, match=re.escape(what)):
        list(with_truth(frames(2), path))


@pytest.mark.parametrize("text", ["no JSON", "[" * 100_000])
def test_what_is_no_json_is_told(text: str, tmp_path: Path) -> None:
    path = tmp_path / "truth.json"
    path.write_text(text)
    with pytest.raises(DataError, match="is no JSON"):
        list(with_truth(frames(2), path))


def test_a_true_shape_of_a_plugins_own_cannot_be_written():
    class Stroke(Circle):
        pass

    told = "a true Stroke cannot be written; what can is: circle, ellipse, polygon, rectangle"
    with pytest.raises(UsageError, match=told):
        truth_to_json([(TrueObject(Stroke(1.0, 2.0, 3.0)),)])


def test_zeros_where_a_kind_needs_nothing_fill_a_table_of_many_kinds(tmp_path: Path) -> None:
    path = tmp_path / "t.csv"
    path.write_text(
        "frames,kind,x_cm,y_cm,radius_cm,angle_deg,weight_g\n0,circle,1,2,1,0,100\n1,none,0,0,nan,0,0\n"
    )
    first, second = with_truth(frames(2), path)
    assert [t.weight_g for t in first.truth or ()] == [100.0]
    assert second.truth == ()
