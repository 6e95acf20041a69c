"""Rows, columns and last cells without a value, and the separators that look like them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from helpers_recordings import frames_of, write
from tactile_graph.errors import DataError
from tactile_graph_sources.readers import head

ROWS, COLUMNS = 6, 5
LOADED = np.random.default_rng(0).uniform(50, 100, (5, ROWS, COLUMNS)).round(1)
HEADER = "time_s," + ",".join(f"r{i}c{j}" for i in range(ROWS) for j in range(COLUMNS)) + "\n"
OUTER = [(i, j) for i in range(ROWS) for j in (0, 4)]
TOLD = {"rows": ROWS, "columns": COLUMNS}
ALONE = "lines of separators alone taken for"


def without(cells: list[tuple[int, int]]) -> np.ndarray:
    frames = LOADED.copy()
    for i, j in cells:
        frames[:, i, j] = np.nan
    return frames


def line(values: np.ndarray, separator: str) -> str:
    return separator.join("" if np.isnan(v) else f"{v:.1f}" for v in values)


def matrices(frames: np.ndarray, separator: str = ";", head: str = "Frame {}\n") -> str:
    return "".join(
        head.format(k) + "".join(f"{line(row, separator)}\n" for row in frame) + "\n"
        for k, frame in enumerate(frames)
    )


def a_line(frames: np.ndarray, header: str = HEADER) -> str:
    lines = (f"{k / 100:.2f},{line(frame.ravel(), ',')}\n" for k, frame in enumerate(frames))
    return header + "".join(lines)


def check(path: Path, frames: np.ndarray, **settings: object) -> list[str]:
    """Read frames, compare them cell by cell, and return what was told of them."""
    found, report = frames_of(path, **settings)
    assert len(found) == len(frames)
    for frame, true in zip(found, frames, strict=True):
        valid = np.isfinite(true) if np.isnan(true).any() else None
        assert np.array_equal(frame.image.values, np.nan_to_num(true))
        assert (frame.image.valid is None) == (valid is None)
        assert valid is None or np.array_equal(frame.image.valid, valid)
    return [*report.counts]


@pytest.mark.parametrize("settings", [{}, TOLD], ids=["untold", "told"])
@pytest.mark.parametrize("head", ["Frame {}\n", ""], ids=["named", "blank lines"])
@pytest.mark.parametrize("separator", [";", "\t"])
@pytest.mark.parametrize(
    "cells",
    [
        [(row, j) for row in blank for j in range(COLUMNS) if (row, j) != but]
        for blank, but in (([0], None), ([2], None), ([5], None), ([0, 5], None), ([0], (0, 2)))
    ],
    ids=["first", "middle", "last", "both", "first but one cell"],
)
def test_a_row_without_a_value_is_a_row(
    cells: list[tuple[int, int]], separator: str, head: str, settings: dict, tmp_path: Path
) -> None:
    frames = without(cells)
    told = check(write(tmp_path, matrices(frames, separator, head)), frames, **settings)
    assert any(ALONE in one for one in told) is not bool(settings)


@pytest.mark.parametrize("settings", [{}, TOLD], ids=["untold", "told"])
@pytest.mark.parametrize(
    ("head", "foot", "is_open"),
    [
        ("", ";;;;\n", False),
        ("", ";;;;\n;;;;\n", False),
        ("Frame {};;;;\n", ";;;;\n", True),
        ("Frame {}\n", ";;;;\n", True),
        ("0.{};;;;\n", "", False),
        ("0.{};;;;\n", "\n", False),
        ("0.{};;;;\n", ";;;;\n", False),
    ],
)
def test_lines_of_separators_part_matrices(
    head: str, foot: str, is_open: bool, settings: dict, tmp_path: Path
) -> None:
    # As spreadsheets write blank lines and lone times.
    text = matrices(LOADED, ";", head).replace("\n\n", f"\n{foot}")
    told = check(write(tmp_path, text), LOADED, **settings)
    assert any(ALONE in one for one in told) is (is_open and not settings)


def test_a_row_without_a_value_is_told_of_one_matrix_alone(tmp_path: Path) -> None:
    frames = without([(0, j) for j in range(COLUMNS)])[:1]
    path = write(tmp_path, matrices(frames))
    told = check(path, frames[:, 1:])
    assert f"recordings with {ALONE} blank ones (give rows=6 if they are rows without a value)" in (
        told
    )
    check(path, frames, **TOLD)


def test_the_last_of_the_first_lines_may_be_of_half_a_matrix(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    frames = without([(0, j) for j in range(COLUMNS)])
    text = matrices(frames)
    monkeypatch.setattr(head, "SAMPLE", text.index("Frame 2") - 20)
    check(write(tmp_path, text), frames)


@pytest.mark.parametrize(
    "cells",
    [[(5, 4)], [(5, 3), (5, 4)], OUTER, [(0, 0)]],
    ids=["last", "last two", "outer columns", "first"],
)
@pytest.mark.parametrize("settings", [{}, TOLD], ids=["untold", "told"])
def test_a_header_rules_over_cells_without_a_value(
    cells: list[tuple[int, int]], settings: dict, tmp_path: Path
) -> None:
    frames = without(cells)
    path = write(tmp_path, a_line(frames))
    check(path, frames, **settings)
    assert frames_of(path, **settings)[0][1].time_s == 0.01


def test_an_empty_last_field_may_be_a_cell_or_a_separator(tmp_path: Path) -> None:
    frames = without([(5, 4)])
    path = write(tmp_path, a_line(frames, ""))
    with pytest.raises(DataError, match=r"then time_column=1, cells=2-31"):
        frames_of(path, **TOLD)
    check(path, frames, time_column="1", cells="2-31", **TOLD)


def test_two_empty_last_fields_are_the_cells_that_are_told(tmp_path: Path) -> None:
    frames = without([(5, 3), (5, 4)])
    check(write(tmp_path, a_line(frames, "")), frames, **TOLD)


@pytest.mark.parametrize("column", [0, 4])
def test_an_outer_column_without_a_value_is_one_where_columns_are_told(
    column: int, tmp_path: Path
) -> None:
    frames = without([(i, column) for i in range(ROWS)])
    check(write(tmp_path, matrices(frames)), frames, **TOLD)
    said = f"Rows: {ROWS}\nColumns: {COLUMNS}\n{matrices(frames)}"
    check(write(tmp_path, said), frames)


def test_empty_columns_that_are_left_out_are_told(tmp_path: Path) -> None:
    told = check(write(tmp_path, matrices(without(OUTER))), LOADED[:, :, 1:4])
    assert "recordings with empty columns left out (give columns=5 if they are cells)" in told


def test_separators_at_the_end_of_lines_are_no_column(tmp_path: Path) -> None:
    text = matrices(LOADED).replace("\n", ";\n").replace("\n;\n", "\n\n")
    for settings in ({}, TOLD):
        told = check(write(tmp_path, text), LOADED, **settings)
        assert not any("empty" in one for one in told)
