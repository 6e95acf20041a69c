"""Tables with one cell a line that say where each cell lies, in units of length."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from helpers_recordings import blobs, frames_of, write
from tactile_graph.errors import DataError

VALUES = blobs(3, 5, 7)


def placed(header: str, cell: str) -> str:
    """Return a line a cell: of frame k, row r, column c and value v."""
    lines = [cell.format(k=k, r=r, c=c, v=v) for (k, r, c), v in np.ndenumerate(VALUES)]
    return "\n".join([header, *lines]) + "\n"


@pytest.mark.parametrize(
    "header",
    [
        "frame,x_mm,y_mm,z_mm,pressure_kpa",
        "frame,x,y,z,pressure_kpa",
        "frame,x_mm,y_mm,z_mm,sigma_kpa",
        "frame,x_mm,y_mm,depth_mm,kpa",
    ],
)
def test_a_height_is_no_reading_where_another_column_is(header: str, tmp_path: Path) -> None:
    frames, report = frames_of(write(tmp_path, placed(header, "{k},{c},{r},{c}.5,{v}")))
    np.testing.assert_array_equal([f.image.values for f in frames], VALUES)
    assert frames[0].image.quantity == "kilopascal"
    assert report.counts[f"recordings with columns left out ({header.split(',')[3]})"] == 1


def test_which_of_several_columns_is_the_reading_beside_a_height_is_asked(tmp_path: Path) -> None:
    text = placed("frame,x_mm,y_mm,z_mm,a_kpa,b_kpa", "{k},{c},{r},{c}.5,{v},{v}")
    with pytest.raises(DataError, match="the value could be any of z_mm, a_kpa, b_kpa; give value"):
        frames_of(write(tmp_path, text))


@pytest.mark.parametrize("header", ["frame,x,y,z", "frame,x_mm,y_mm,z_mm"])
def test_a_height_alone_is_the_reading(header: str, tmp_path: Path) -> None:
    frames, _ = frames_of(write(tmp_path, placed(header, "{k},{c},{r},{v}")))
    np.testing.assert_array_equal([f.image.values for f in frames], VALUES)


# -- offset lines ------------------------------------------------------------------------------


@pytest.mark.parametrize("header", ["frame,x_mm,y_mm,kpa", "frame,y_mm,x_mm,kpa"])
@pytest.mark.parametrize("offset", [2.5, 5 / 3, -2.5])
def test_lines_that_are_offset_against_each_other_are_refused(
    header: str, offset: float, tmp_path: Path
) -> None:
    cells = [(k, 5 * c + offset * (r % 2), 4.33 * r) for k, r, c in np.ndindex(3, 8, 9)]
    text = "\n".join([header, *(f"{k},{x:.6f},{y:.2f},5" for k, x, y in cells)])
    lines = "rows" if header.startswith("frame,x") else "columns"
    with pytest.raises(DataError, match=f"its {lines} are offset .* hexagonal .* lie 5 .*griddata"):
        frames_of(write(tmp_path, text))


def test_whole_numbers_that_are_offset_are_refused_unless_the_shape_is_told(
    tmp_path: Path,
) -> None:
    cells = [(k, r, 2 * c + r % 2) for k, r, c in np.ndindex(3, 8, 9)]
    lines = [f"{k},{r},{c},5" for k, r, c in cells]
    path = write(tmp_path, "\n".join(["frame,row,col,adc", *lines]))
    with pytest.raises(DataError, match="a row lie 2 apart, those of all rows 1"):
        frames_of(path)
    frames, _ = frames_of(path, rows=8, columns=18)
    assert np.count_nonzero(frames[0].image.valid) == 72
