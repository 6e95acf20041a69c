"""Columns with names are not taken for those of one matrix, nor axes for cells."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from helpers_recordings import frames_of, write
from tactile_graph.errors import DataError

RNG = np.random.default_rng(0)


def table(folder: Path, values: np.ndarray, names: list[str]) -> Path:
    lines = [",".join(f"{v:.1f}" for v in row) for row in values]
    return write(folder, "\n".join([",".join(names), *lines]) + "\n", "a.csv")


@pytest.mark.parametrize("n_lines", [12, 30, 60, 300])
@pytest.mark.parametrize("name", ["taxel{}", "F{}_N", "p{}"])
def test_lines_under_names_are_asked_about_however_many(
    n_lines: int, name: str, tmp_path: Path
) -> None:
    path = table(tmp_path, RNG.normal(220, 1, (n_lines, 60)), [name.format(k) for k in range(60)])
    with pytest.raises(DataError, match=f"{n_lines} lines of 60 values could be one matrix or"):
        frames_of(path)
    assert len(frames_of(path, rows=6, columns=10)[0]) == n_lines


@pytest.mark.parametrize("first", ["A", "1"])
def test_columns_of_a_spreadsheet_have_no_names(first: str, tmp_path: Path) -> None:
    names = [chr(ord(first) + k) if first == "A" else str(k + 1) for k in range(12)]
    frames, report = frames_of(table(tmp_path, RNG.normal(220, 1, (8, 12)), names))
    assert [f.image.shape for f in frames] == [(8, 12)]
    assert report.counts[
        "recordings with 8 lines of 12 values assumed to be the rows of one matrix"
    ]


@pytest.mark.parametrize("shape", [(16, 16), (8, 12)])
@pytest.mark.parametrize(
    "name", ["V{}", "Var{}", "Column{}", "column_{}", "c{}", "col{}", "COL{}", "x{}", "Unnamed: {}"]
)
@pytest.mark.parametrize("first", [0, 1])
def test_columns_that_programs_count_up_have_no_names(
    shape: tuple[int, int], name: str, first: int, tmp_path: Path
) -> None:
    n, width = shape
    names = [name.format(first + k) for k in range(width)]
    frames, report = frames_of(table(tmp_path, RNG.normal(220, 1, shape), names))
    assert [f.image.shape for f in frames] == [shape]
    told = f"recordings with {n} lines of {width} values assumed to be the rows of one matrix"
    assert report.counts[told] == 1


@pytest.mark.parametrize(("names", "asked"), [("abcdefgh", False), ("abcdefgk", True)])
def test_columns_by_the_letters_in_order_have_no_names(
    names: str, asked: bool, tmp_path: Path
) -> None:
    path = table(tmp_path, RNG.normal(220, 1, (8, 8)), [*names])
    if asked:
        with pytest.raises(DataError, match=r"its columns have names \(a, b, …\)"):
            frames_of(path)
    else:
        assert [f.image.shape for f in frames_of(path)[0]] == [(8, 8)]


@pytest.mark.parametrize("numbers", [[*range(11), 12], [*range(11, -1, -1)]])
def test_columns_out_of_count_have_names(numbers: list[int], tmp_path: Path) -> None:
    path = table(tmp_path, RNG.normal(220, 1, (12, 12)), [f"V{k}" for k in numbers])
    with pytest.raises(DataError, match="12 lines of 12 values could be one matrix or"):
        frames_of(path)


@pytest.mark.parametrize("settings", [{}, {"rows": 16, "columns": 3}])
@pytest.mark.parametrize(
    ("name", "axes"), [("r{}c{}_{}", "xyz"), ("s{}{}_{}", ["fx", "fy", "fz"]), ("p{}_{}{}", "xy")]
)
def test_axes_of_cells_are_to_be_chosen(
    name: str, axes: list[str], settings: dict[str, int], tmp_path: Path
) -> None:
    names = [name.format(r, c, q) for r in range(4) for c in range(4) for q in axes]
    values = RNG.normal(0, 1, (30, 16, len(axes)))
    path = table(tmp_path, values.reshape(30, -1), names)
    asked = rf"its columns are {len(axes)} axes .* of 16 cells .*such as cells='\*{axes[-1]}'"
    with pytest.raises(DataError, match=asked):
        frames_of(path, **settings)
    frames, _ = frames_of(path, cells=f"*{axes[-1]}", rows=4, columns=4)
    right = values[..., -1].reshape(30, 4, 4)
    np.testing.assert_allclose([f.image.values for f in frames], right, atol=0.051)
