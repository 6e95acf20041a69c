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
SQUARE = ",".join(f"c{k}" for k in range(64, 81))
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
        for blank, but in (([2], None), ([0, 3], None), ([0], (0, 2)))
    ],
    ids=["middle", "first and another", "first but one cell"],
)
def test_a_row_without_a_value_is_a_row(
    cells: list[tuple[int, int]], separator: str, head: str, settings: dict, tmp_path: Path
) -> None:
    frames = without(cells)
    told = check(write(tmp_path, matrices(frames, separator, head)), frames, **settings)
    assert any("taken for rows without a value" in t for t in told) is not bool(settings)


@pytest.mark.parametrize("head", ["Frame {}\n", ""], ids=["named", "blank lines"])
@pytest.mark.parametrize("rows", [[0], [5], [0, 5]], ids=["first", "last", "both"])
def test_an_outer_row_without_a_value_is_one_where_rows_are_told(
    rows: list[int], head: str, tmp_path: Path
) -> None:
    frames = without([(row, j) for row in rows for j in range(COLUMNS)])
    path = write(tmp_path, matrices(frames, head=head))
    told = check(path, np.delete(frames, rows, axis=1))
    remedy = "(give rows=6 if they are rows without a value)"
    assert f"recordings with {ALONE} blank ones {remedy}" in told
    assert not any(ALONE in one for one in check(path, frames, **TOLD))


@pytest.mark.parametrize("filled", ["", ";;;;"])
@pytest.mark.parametrize("total", ["{};;;;\n", ";;;;{}\n"])
def test_a_lone_number_behind_a_matrix_is_no_row(total: str, filled: str, tmp_path: Path) -> None:
    text = matrices(LOADED, head=f"Frame {{}}{filled}\n")
    for k in range(len(LOADED)):
        text = text.replace("\n\n", f"\n{total.format(100 + 17 * k % 5)}{filled}\v\n", 1)
    told = check(write(tmp_path, text.replace("\v", "")), LOADED)
    assert any("lines of separators and one number taken for blank ones" in one for one in told)


def test_a_line_of_separators_among_frames_of_a_line_each_is_none(tmp_path: Path) -> None:
    lines = a_line(np.concatenate([LOADED, LOADED[:1]]), "").splitlines(keepends=True)
    lines[3] = "," * 30 + "\n"
    path = write(tmp_path, "".join(lines))
    check(path, np.delete(np.concatenate([LOADED, LOADED[:1]]), 3, axis=0), **TOLD)


def test_a_row_that_is_blank_in_one_matrix_alone_is_damage(tmp_path: Path) -> None:
    frames = np.concatenate([LOADED, LOADED])
    lines = matrices(frames).splitlines(keepends=True)
    lines[3] = ";;;;\n"
    assert not any(ALONE in one for one in check(write(tmp_path, "".join(lines)), frames[1:]))


def test_a_line_of_separators_is_no_row_where_matrices_are_not_alike(tmp_path: Path) -> None:
    lines = matrices(LOADED[:2], head="").replace("\n\n", "\n").splitlines(keepends=True)
    lines[3] = ";;;;\n"
    with pytest.raises(DataError, match="no whole frame"):
        frames_of(write(tmp_path, "".join(lines)), **TOLD)


@pytest.mark.parametrize("settings", [{}, TOLD], ids=["untold", "told"])
@pytest.mark.parametrize(
    ("head", "foot", "is_open"),
    [
        ("", ";;;;\n", False),
        ("", ";;;;\n;;;;\n", False),
        ("Frame {};;;;\n", ";;;;\n", False),
        ("Frame {}\n", ";;;;\n", True),
        ("Frame {}\n", ";;;;\n\n", True),
        ("Frame {};;;;\n", ";;;;\n;;;;\n", True),
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
    frames = without([(1, j) for j in range(COLUMNS)])
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


@pytest.mark.parametrize("spare", ["B1", "c64", "adc64", "T1", "c64,c65", "B1,B2", "note", SQUARE])
def test_an_empty_column_that_has_a_name_is_no_cell_by_it(spare: str, tmp_path: Path) -> None:
    frames = np.random.default_rng(1).uniform(50, 100, (5, 8, 8)).round(1)
    stem = "adc" if "adc" in spare else "c"
    header = "time_s," + ",".join(f"{stem}{k}" for k in range(64)) + f",{spare}\n"
    ends = "," * (spare.count(",") + 1) + "\n"
    check(
        write(tmp_path, a_line(frames, header).replace("\n", ends).replace(ends, "\n", 1)), frames
    )


@pytest.mark.parametrize("name", ["v{n}", "{letter}{j}"])
def test_an_empty_last_column_is_a_cell_where_names_fill_a_grid_with_it(
    name: str, tmp_path: Path
) -> None:
    frames = np.random.default_rng(1).uniform(50, 100, (5, 4, 4)).round(1)
    frames[:, 3, 3] = np.nan
    places = [(i, j) for i in range(4) for j in range(4)]
    names = [name.format(n=4 * i + j, letter="ABCD"[i], j=j + 1) for i, j in places]
    check(write(tmp_path, a_line(frames, f"time_s,{','.join(names)}\n")), frames)


def test_an_empty_last_field_may_be_a_cell_or_a_separator(tmp_path: Path) -> None:
    frames = without([(5, 4)])
    path = write(tmp_path, a_line(frames, ""))
    _, report = frames_of(path, **TOLD)
    assert any("give time_column=1 if it is none" in told for told in report.counts)
    check(path, frames, time_column="1", **TOLD)
    check(path, frames, time_column="1", cells="2-31", **TOLD)


@pytest.mark.parametrize("n", [2, 5])
@pytest.mark.parametrize("time", ["", "0.{},"], ids=["cells", "time and cells"])
@pytest.mark.parametrize("told", [True, False], ids=["told", "said"])
def test_a_separator_behind_cells_of_which_the_first_climbs_is_no_cell(
    told: bool, time: str, n: int, tmp_path: Path
) -> None:
    frames = LOADED[:n].copy()
    frames[:, 0, 0] = 10.0 + 3 * np.arange(n)
    said = "" if told else f"Rows: {ROWS}\nColumns: {COLUMNS}\n"
    lines = (time.format(k) + line(f.ravel(), ",") + ",\n" for k, f in enumerate(frames))
    path = write(tmp_path, said + "".join(lines))
    notes = check(path, frames, **(TOLD if told else {}))
    assert any("though the first cell climbs" in note for note in notes) is (n > 2)
    found, _ = frames_of(path, **(TOLD if told else {}))
    assert found[1].time_s == (0.1 if time else None)


@pytest.mark.parametrize("separators", ["", ","])
def test_a_last_cell_without_a_value_is_one_behind_a_date_and_a_time_of_day(
    separators: str, tmp_path: Path
) -> None:
    frames = without([(5, 4)])
    lines = (
        f"2024-03-01,12:00:0{k},{line(f.ravel(), ',')}{separators}\n" for k, f in enumerate(frames)
    )
    path = write(tmp_path, "".join(lines))
    check(path, frames, **TOLD)
    assert frames_of(path, **TOLD)[0][1].time_s == 1.0


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


def test_cells_named_by_row_and_column_are_cells_though_the_last_row_has_no_value(
    tmp_path: Path,
) -> None:
    frames = without([(ROWS - 1, j) for j in range(COLUMNS)])
    frames[:, 0, 0] = 100.0 + 3.0 * np.arange(len(frames))  # climbs as a time does
    rows = [f"{k}," + line(f.ravel(), ",") + ",\n" for k, f in enumerate(frames)]
    text = HEADER.replace("time_s", "frame").replace("\n", ",\n") + "".join(rows)
    check(write(tmp_path, text), frames, **TOLD)


def test_matrices_without_any_row_of_two_values_are_read_as_told(tmp_path: Path) -> None:
    text = "5,,,\n,,,\n,,,\n\n,,,\n,6,,\n,,,\n\n,,,\n,,,\n,,7,\n"
    found, _ = frames_of(write(tmp_path, text), rows=3, columns=4)
    assert [frame.image.values.max() for frame in found] == [5.0, 6.0, 7.0]
