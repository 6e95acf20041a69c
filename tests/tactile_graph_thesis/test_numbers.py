"""The thesis' numbers as data."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph_thesis.measure.fields import THESIS as RADII
from tactile_graph_thesis.measure.rectangles import THESIS as RECTANGLES
from tactile_graph_thesis.numbers import error_table, numbers

TABLES = ("table-4.3", "table-4.4", "table-4.5", "table-4.7", "table-4.8", "table-5.2")


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


@pytest.mark.parametrize(
    ("name", "pipeline"), [("table-4.7", "rectangle-1"), ("table-4.8", "rectangle-2")]
)
def test_rectangles_are_those_of_the_fitters_family(name: str, pipeline: str) -> None:
    table = error_table(name)
    for row, label in zip(table.values, table.objects, strict=True):
        assert np.ravel(RECTANGLES[pipeline][label]).tolist() == row.tolist()


def test_radii_are_those_of_the_mrf_family() -> None:
    table = error_table("table-5.2")
    for row, label in zip(table.values, table.objects, strict=True):
        assert tuple(row[1:]) == RADII[label]


def test_limits_are_the_thesis_ones() -> None:
    assert numbers("readings")["each"] == 20
    assert numbers("threshold")["chosen_v"] == 0.01
