"""Columns as text: byte for byte what single numbers and single rows are."""

from __future__ import annotations

import csv
from typing import Any

import numpy as np
import pytest

from tactile_graph.cli.output import column_texts
from tactile_graph.cli.output.column_texts import csv_lines, number_texts
from tactile_graph.foreign_text import csv_line


@pytest.fixture(params=["orjson", "plain"])
def by(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> str:
    """With orjson, and without it."""
    if request.param == "plain":
        monkeypatch.setattr(column_texts, "_dumps", lambda: None)
    else:
        pytest.importorskip("orjson")
    return str(request.param)


def test_numbers_are_those_that_python_writes(by: str) -> None:
    rng = np.random.default_rng(0)
    any_bits = rng.integers(0, 2**64, 3000, np.uint64).view(np.float64)
    edges = [10.0**k for k in range(-8, 20)] + [1e-4 - 1e-20, 1e16 - 2.0, 0.0, -0.0, 5e-324, 1e308]
    numbers = [*any_bits.tolist(), *rng.normal(0.0, 30.0, 2000).tolist(), *edges]
    numbers += [float("nan"), float("inf"), float("-inf"), 1.0, 2.0**53]
    assert [*number_texts(numbers)] == [repr(number) for number in numbers]
    assert [*number_texts([0, -3, 2**80])] == ["0", "-3", str(2**80)]
    assert [*number_texts([])] == []


@pytest.mark.parametrize(
    "column",
    [
        [1, 2, -3],
        [None, None, None],
        [0.1, -0.0, 1e-5],
        [0.1, None, float("nan")],
        [None, 7, None],
        ["=1+1", 'a"b\x1b', "ok"],
        ["", None, "two, of them"],
        ["line\nline", "-2", "x\r"],
        [True, False, None],
        [1, 2.0, "mixed"],
        [np.float64(0.1), np.int64(3), 2**70],
    ],
)
def test_columns_become_the_lines_that_rows_become(column: list[Any], by: str) -> None:
    columns = [["a", "b", ""], column, [0.5, 1.5, 2.5]]
    lines = csv_lines(columns)
    assert lines == "".join(csv_line(row) for row in zip(*columns, strict=True))
    assert len([*csv.reader(lines.splitlines(keepends=True))]) == 3
