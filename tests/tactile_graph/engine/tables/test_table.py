"""Results as a table: a row a frame and object, nothing lost, numbers with their units."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from typing import Any, Literal, NamedTuple

import numpy as np
import pytest

from helpers_graphs import frame, registry
from tactile_graph import Circle, Degenerate, Frame, Image, load, loads
from tactile_graph.api.result import Result
from tactile_graph.api.results import Results
from tactile_graph.engine.tables.table import ObjectTable, make_table, units_of
from tactile_graph.errors import FrameError, UsageError
from tactile_graph.vocabulary import words_and_unit
from tactile_graph.wires import TrueObject
from tactile_graph.wires.frame_stack import FrameStack


class Found(NamedTuple):
    circles: list[Circle]
    count: int  # type: ignore[assignment]
    state: Literal["rests", "moves"]


def found(image: Image) -> Found:
    n = int(image.values[0, 0])
    return Found([Circle(i, 2.0 * i, 1.0) for i in range(1, n + 1)], n, "rests")


def smaller(circle: Circle) -> Circle:
    if circle.x_cm == 2.0:
        raise Degenerate("too small already")
    return Circle(circle.x_cm, circle.y_cm, 0.5)


NODES = """
pipeline: p
nodes:
  found: {step: found, in: frame}
  smaller: {step: smaller, in: found.circles, each: true}
outputs: [found, smaller]
"""


def table_of(number: float, truth: Any = None) -> list[dict[str, Any]]:
    pipeline = loads(NODES, "p.yaml", registry({"found": found, "smaller": smaller}))
    given = frame(number)
    given = Frame(given.image, truth=truth)
    table = make_table(pipeline, tuple(pipeline.outputs), long=True)
    keys = [c.key for c in table.columns]
    rows = list(table.rows(pipeline.run(given)))
    assert all(row.keys() <= set(keys) for row in rows)
    return rows


def test_each_item_of_each_list_has_a_row_in_its_place() -> None:
    rows = table_of(3)
    assert [(r["output"], r.get("item"), r["outcome"]) for r in rows] == [
        ("found", None, "ok"),
        ("found.circles", 1, "ok"),
        ("found.circles", 2, "ok"),
        ("found.circles", 3, "ok"),
        ("smaller", 1, "ok"),
        ("smaller", 2, "failed: too small already"),
        ("smaller", 3, "ok"),
    ]
    assert (rows[0]["count"], rows[0]["state"], rows[0]["type"]) == (3, "rests", "Found")
    assert [(r["type"], r["x_cm"], r["radius_cm"]) for r in rows if "x_cm" in r][-1] == (
        "Circle", 3.0, 0.5,
    )  # fmt: skip


def test_a_frame_without_objects_keeps_its_rows_and_says_so() -> None:
    rows = table_of(0)
    assert [(r["output"], r["outcome"]) for r in rows] == [
        ("found", "ok"),
        ("found.circles", "no items"),
        ("smaller", "skipped: no items to run for"),
    ]


def test_objects_have_their_errors_where_the_truth_is_known() -> None:
    rows = table_of(1, truth=(TrueObject(Circle(1.0, 2.5, 1.0)),))
    assert [r["centre_error_cm"] for r in rows if "x_cm" in r] == [0.5, 0.5]
    assert [r["radius_error_cm"] for r in rows if "x_cm" in r] == [0.0, -0.5]


def test_every_column_of_numbers_has_a_unit_and_sums_of_readings_have_the_frames() -> None:
    pipeline = load("contacts")
    table = ObjectTable(pipeline, ("load", "contacts"))
    units = units_of(table, ["kilopascal"])
    numbers = {c.key for c in table.columns if c.kind in (int, float)}
    assert units.keys() == numbers
    assert (units["x_cm"], units["load"], units["peak"], units["count"]) == (
        "cm",
        "kPa",
        "kPa",
        "1",
    )
    assert units_of(table, ["counts"])["load"] == "counts"


class Outcome(NamedTuple):
    outcome: str
    total: float


def graded(image: Image) -> Outcome:
    return Outcome("good", 2.0)


def total(image: Image) -> float:
    return float(image.total)


def test_a_name_that_the_table_has_itself_is_nobody_elses() -> None:
    nodes = """
pipeline: p
nodes:
  graded: {step: graded, in: frame}
  time_s: {step: total, in: frame}
  label: {step: total, in: frame}
outputs: [graded, time_s, label]
"""
    pipeline = loads(nodes, "p.yaml", registry({"graded": graded, "total": total}))
    table = make_table(pipeline, tuple(pipeline.outputs), long=False)
    keys = [c.key for c in table.columns]
    assert len(keys) == len({*keys})
    frames = [frame(3.0, i, time_s=0.5) for i in range(40)]
    (row, *_) = table.rows(pipeline.run(frames[0]))
    told = {"graded.outcome": "ok", "graded.outcome.value": "good", "graded.total": 2.0}
    assert row == {
        "frame": 0, "time_s": 0.5, "label": "", **told, "time_s.outcome": "ok",
        "time_s.value": 12.0, "label.outcome": "ok", "label.value": 12.0,
    }  # fmt: skip
    columns = table.of_block(pipeline.runner().block(FrameStack.of(frames)))
    assert {key: column[0] for key, column in columns.items()} == row
    assert pipeline.run(frames[0]).row() == {
        "frame": 0, "time_s": 0.5, "graded.outcome.value": "good", "graded.total": 2.0,
        "time_s.value": 12.0, "label.value": 12.0,
    }  # fmt: skip


@pytest.mark.parametrize("outputs", ["circle, circle.x_cm", "circle.x_cm, circle"])
def test_a_field_that_is_an_output_as_well_has_a_column_of_its_own(outputs: str) -> None:
    nodes = f"""
pipeline: p
nodes: {{circle: {{step: one, in: frame}}}}
outputs: [{outputs}]
"""

    def one(image: Image) -> Circle:
        return Circle(float(image.total), 2.0, 1.0)

    pipeline = loads(nodes, "p.yaml", registry({"one": one}))
    table = make_table(pipeline, tuple(pipeline.outputs), long=False)
    keys = [c.key for c in table.columns]
    assert len(keys) == len({*keys})
    frames = [frame(3.0, i, time_s=0.5) for i in range(40)]
    (row, *_) = table.rows(pipeline.run(frames[0]))
    assert {*keys} - {"circle.radius_error_cm", "circle.centre_error_cm"} == {*row}
    assert (row["circle.x_cm"], row["circle.x_cm.value"]) == (12.0, 12.0)
    columns = table.of_block(pipeline.runner().block(FrameStack.of(frames)))
    assert {key: columns[key][0] for key in row} == row


@pytest.mark.parametrize(
    ("name", "expected"),
    [("vx_cm_s", ("vx", "cm/s")), ("age_s", ("age", "s")), ("area_cm2", ("area", "cm²")),
     ("pressure_n_cm2", ("pressure", "N/cm²")), ("drift_v_s", ("drift", "V/s")),
     ("n_s", ("n", "s")), ("cm", ("cm", "")), ("n_points", ("n points", ""))],
)  # fmt: skip
def test_a_name_is_words_and_a_unit(name: str, expected: tuple[str, str]) -> None:
    assert words_and_unit(name) == expected


def test_results_become_a_pandas_table_of_either_form() -> None:
    pytest.importorskip("pandas")
    pipeline = loads(NODES, "p.yaml", registry({"found": found, "smaller": smaller}))
    frames = [frame(n, n) for n in (3, 1)]
    wide = pipeline.stream(frames).to_pandas()
    assert wide["found.count"].tolist() == [3, 1]
    assert wide["smaller.outcome"].tolist() == ["item 2 failed: too small already", "ok"]
    long = pipeline.stream(frames).to_pandas(long=True)
    assert len(long) == 7 + 3
    assert long.attrs["units"]["radius_cm"] == "cm"
    assert np.isnan(long["radius_cm"][0])


@pytest.mark.parametrize("long", [False, True])
def test_numbers_that_are_all_missing_are_numbers_in_pandas(long: bool) -> None:
    pytest.importorskip("pandas")
    pipeline = loads(NODES, "p.yaml", registry({"found": found, "smaller": smaller}))
    timeless = [np.zeros((2, 2))]
    assert pipeline.stream(timeless).to_pandas(long=long)["time_s"].dtype == float
    none = pipeline.stream([]).to_pandas(long=long)
    assert [none[c].dtype for c in ("frame", "time_s")] == [int, float]
    kinds = pipeline.stream(timeless).to_pandas(long=long).dtypes
    assert all(kinds[name].kind in "if" for name in none.attrs["units"])


def test_a_stream_whose_frames_were_taken_says_so() -> None:
    pytest.importorskip("pandas")
    pipeline = loads(NODES, "p.yaml", registry({"found": found, "smaller": smaller}))
    stream = pipeline.stream([frame(1), frame(2)])
    next(stream)
    assert len(stream.to_pandas()) == 1
    assert list(stream) == []
    with pytest.raises(UsageError, match="no frames are left: all results of the stream were"):
        stream.to_pandas()

    def interrupted() -> Iterator[Frame]:
        yield frame(1)
        raise KeyboardInterrupt

    stream = pipeline.stream(interrupted())
    with pytest.raises(KeyboardInterrupt):
        list(stream)
    with pytest.raises(UsageError, match="the stream ended with KeyboardInterrupt"):
        stream.to_pandas()


def test_whoever_goes_on_after_errors_comes_to_the_end() -> None:
    pipeline = loads(NODES, "p.yaml", registry({"found": found, "smaller": smaller}))
    stream = pipeline.stream([frame(1), "no frame", frame(2)])  # type: ignore[list-item]
    told: list[str] = []
    for _ in range(9):
        try:
            next(stream)
        except StopIteration:
            break
        except UsageError as error:
            told.append(str(error))
    assert [text.partition(",")[0] for text in told] == [
        "a frame is needed",
        "the stream ended with UsageError",
    ]


def test_an_interrupt_between_two_frames_ends_no_stream() -> None:
    pipeline = loads(NODES, "p.yaml", registry({"found": found, "smaller": smaller}))
    results = iter(pipeline.stream([frame(1), frame(2)]))

    class Interrupted(Iterator[Result]):
        n = 0

        def __next__(self) -> Result:
            self.n += 1
            if self.n == 2:
                raise KeyboardInterrupt
            return next(results)

    stream = Results(pipeline, ("found",), Interrupted())
    next(stream)
    with pytest.raises(KeyboardInterrupt):
        next(stream)
    assert len(list(stream)) == 1


def test_without_pandas_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(UsageError, match=r"to_pandas needs pandas: pip install pandas"):
        load("contacts").stream([np.ones((4, 4))]).to_pandas()


@pytest.mark.slow
def test_a_table_that_a_bad_frame_ends_says_how_many_came_before() -> None:
    pytest.importorskip("pandas")
    pipeline = loads("pipeline: p\nnodes: {n: {step: peak, in: frame}}\noutputs: [n]",
                     steps={"peak": _peak})  # fmt: skip
    with pytest.raises(FrameError, match="frame 3: a frame takes real numbers") as error:
        pipeline.stream([*np.ones((3, 2, 2)), np.full((2, 2), "x")]).to_pandas()
    (note,) = error.value.__notes__
    assert note.startswith("3 frames came before that, and their rows are lost")


def _peak(image: Image) -> float:
    return float(image.peak)
