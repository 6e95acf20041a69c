"""The thesis' numbers as data."""

from __future__ import annotations

from typing import Any

import pytest
import yaml

from tactile_graph_thesis.measure.rectangles import OBJECTS
from tactile_graph_thesis.numbers import FILE, error_table, numbers

TABLES = ("table-4.3", "table-4.4", "table-4.5", "table-4.7", "table-4.8", "table-5.2", "table-2.2")

KEYS = ("readings", "threshold", "variance", "table-4.9", "identification")


def everything() -> dict[str, Any]:
    """Return the whole file as data."""
    return dict(yaml.safe_load(FILE.read_text(encoding="utf-8")))


@pytest.mark.parametrize("name", TABLES)
def test_a_table_is_rectangular_has_units_and_a_place(name: str) -> None:
    table = error_table(name)
    assert table.values.shape == (len(table.objects), len(table.columns))
    assert len(table.units) == len(table.columns)
    assert name.replace("-", " ") in table.place
    assert not table.values.flags.writeable


@pytest.mark.parametrize("name", TABLES[:5])
def test_no_average_exceeds_its_maximum(name: str) -> None:
    values = error_table(name).values
    assert (values[:, 1::2] <= values[:, ::2]).all()


def test_rectangles_and_radii_are_as_printed() -> None:
    first, second = error_table("table-4.7"), error_table("table-4.8")
    assert first.objects == second.objects == OBJECTS
    assert first.values.tolist() == [
        [21.0, 10.6, 4.9, 3.9, 1.9, 1.1],
        [9.0, 4.8, 3.4, 1.9, 3.4, 1.7],
    ]
    assert second.values.tolist() == [
        [21.0, 10.6, 4.9, 3.8, 1.7, 1.0],
        [9.0, 4.8, 3.3, 1.6, 1.6, 1.3],
    ]
    assert error_table("table-5.2").values.tolist() == [[6.9, 6.3, 6.3], [7.7, 7.3, 7.3]]


def test_errors_of_circles_are_as_printed() -> None:
    printed = {
        "table-4.3": [[0.4, 0.3, 2.0, 1.3, 2.2, 1.2], [1.1, 0.7, 0.6, 0.4, 2.3, 2.0],
                      [1.5, 0.6, 1.5, 0.9, 2.6, 2.0]],
        "table-4.4": [[0.8, 0.5, 1.2, 1.0, 1.3, 0.8], [0.5, 0.4, 0.4, 0.3, 2.0, 1.6],
                      [2.0, 0.8, 1.4, 0.7, 2.2, 1.7]],
        "table-4.5": [[0.9, 0.6, 1.0, 0.6, 0.4, 0.3], [0.7, 0.4, 0.6, 0.5, 1.3, 1.0],
                      [0.7, 0.5, 0.6, 0.4, 0.7, 0.4]],
    }  # fmt: skip
    assert {name: error_table(name).values.tolist() for name in printed} == printed


def test_every_other_number_is_as_printed() -> None:
    said = {key: {**numbers(key)} for key in KEYS}
    for one in said.values():
        assert one.pop("place")
    assert said == {
        "readings": {"each": 20},
        "threshold": {
            "low_v": 0.005,
            "high_v": 0.03,
            "best_v": [0.01, 0.015],
            "chosen_v": 0.01,
            "footprints_v": [0.002, 0.02],
            "error_below_cm": 1.0,
        },
        "variance": {"flat_from": 14, "variance_cm2": 0.5},
        "table-4.9": {"readings": 25, "right_percent": 100},
        "identification": {"beyond_g": 1000, "error_below_percent": 5},
    }
    weights = [[1860, 6.9], [1090, 6.1], [675, 4.3], [1280, 3.8], [1000, 2.5]]
    assert error_table("table-2.2").values.tolist() == weights


def test_nothing_of_the_file_is_left_out() -> None:
    assert set(everything()) == {*TABLES, *KEYS}
