"""Columns follow from types, and hold exactly what values of those types flatten into."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal, NamedTuple

import numpy as np
import pytest

from tactile_graph import Circle, Ellipse, Frame, Image, Mask, Points, Polygon, Rectangle
from tactile_graph.engine.tables.columns import Column, OutputColumns, _columns
from tactile_graph.engine.tables.rows import fields_in_tables, scalars
from tactile_graph.engine.tables.table import without_columns
from tactile_graph.vocabulary import error_name, words_and_unit


class Inner(NamedTuple):
    angle_rad: float
    name: str | None


class Outer(NamedTuple):
    inner: Inner
    items: list[Circle]
    circle: Circle


class Counted(NamedTuple):
    items: tuple[int, ...]
    count: int


@dataclass
class Record:
    total: float
    name: str | None
    cells: np.ndarray
    side: Literal["left", "right"] = "left"
    _own: int = 0


@dataclass(frozen=True)
class Several:
    items: tuple[int, ...]

    @property
    def count(self) -> int:
        return len(self.items)


CIRCLE = Circle(1.0, 2.0, 3.0)
VALUES = [
    (float, 1.5), (int, 2), (bool, True), (str, "x"), (np.float64, np.float64(1.0)),
    (Literal["a", "b"], "a"),
    (Circle, CIRCLE), (Ellipse, Ellipse(1.0, 1.0, 2.0, 1.0, 0.0)),
    (Rectangle, Rectangle(1.0, 1.0, 2.0, 1.0, 0.0)),
    (Polygon, Polygon(np.eye(3)[:, :2].copy())), (Points, Points(np.zeros((3, 2)))),
    (Image, Image(np.ones((2, 2)))), (Mask, Mask(np.ones((2, 2), bool))),
    (list[Circle], (CIRCLE,)), (tuple[float, ...], (1.0, 2.0)),
    (Record, Record(1.0, None, np.ones(2))), (Several, Several((1, 2))),
    (Inner, Inner(1.0, "n")), (Outer, Outer(Inner(1.0, "n"), [CIRCLE], CIRCLE)),
]  # fmt: skip


@pytest.mark.parametrize(("kind", "value"), VALUES, ids=lambda v: str(v)[:30])
def test_a_types_columns_are_its_values_scalars(kind: Any, value: Any):
    assert [c.key for c in _columns("out", "out", kind)] == list(scalars("out", value))


def test_a_dataclass_has_its_numbers_texts_and_counts_in_tables_and_a_dict_is_told_of():
    assert fields_in_tables(Record) == ("total", "name", "side")
    assert fields_in_tables(Several) == ("count",)
    assert fields_in_tables(Frame) == ()  # what tells frames apart is there
    known = OutputColumns("known", (Column("known", "known", "", "", float),), ())
    told = "no columns of d: its type tells no number; .jsonl holds all"
    assert without_columns([known, OutputColumns("d", (), ())]) == told
    assert without_columns([known]) == ""


def test_a_field_of_a_dataclass_that_holds_other_than_it_says_has_no_cell():
    held: Any = np.array([1.0, 2.0])
    assert scalars("r", Record(held, None, held)) == {
        "r.total": None, "r.name": None, "r.side": "left"
    }  # fmt: skip
    held = np.array(1.5)
    assert type(scalars("r", Record(held, "n", held))["r.total"]) is float


def test_a_record_that_counts_its_list_itself_gets_one_column_for_it():
    assert [c.key for c in _columns("c", "c", Counted)] == ["c.count"]


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("radius_cm", ("radius", "cm")), ("area_cm2", ("area", "cm²")),
        ("angle_deg", ("angle", "°")), ("contact_area_cm2", ("contact area", "cm²")),
        ("force_n", ("force", "N")), ("n_cells", ("n cells", "")), ("count", ("count", "")),
        ("cm", ("cm", "")),
    ],
)  # fmt: skip
def test_units_are_read_from_names(name, expected):
    assert words_and_unit(name) == expected


@pytest.mark.parametrize(
    ("measure", "expected"),
    [
        ("radius_cm", "radius_error_cm"), ("pressure_n_cm2", "pressure_error_n_cm2"),
        ("vx_cm_s", "vx_error_cm_s"), ("torque_n_cm", "torque_error_n_cm"),
        ("centre_v_cm", "centre_v_error_cm"),
    ],
)  # fmt: skip
def test_an_errors_name_keeps_the_whole_unit_behind(measure, expected):
    assert error_name(measure) == expected
