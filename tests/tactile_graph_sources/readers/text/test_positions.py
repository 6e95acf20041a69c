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


# -- strips ------------------------------------------------------------------------------------


@pytest.mark.parametrize("n", [1, 3])
@pytest.mark.parametrize("upright", [False, True])
def test_a_strip_is_read_its_pitch_across_taken_from_along_it(
    n: int, upright: bool, tmp_path: Path
) -> None:
    header, line = ("frame,y_mm,x_mm,kpa", "column") if upright else ("frame,x_mm,y_mm,kpa", "row")
    path = write(
        tmp_path,
        "\n".join([header, *(f"{k},{5 * c},2.5,{c}" for k in range(n) for c in range(12))]),
    )
    frames, report = frames_of(path)
    assert len(frames) == n
    assert frames[0].image.shape == ((12, 1) if upright else (1, 12))
    assert frames[0].image.pitch_cm == pytest.approx((0.5, 0.5))
    np.testing.assert_array_equal(frames[0].image.values.ravel(), np.arange(12.0))
    told = [name for name in report.counts if name.endswith(f"as there is one {line} alone")]
    assert len(told) == 1
    assert not frames_of(path, pitch_cm=(0.5, 2.0))[1].counts.keys() & set(told)


def test_a_strip_that_grows_a_second_row_later_is_refused(tmp_path: Path) -> None:
    cells = [(k, c, 0) for k in range(50) for c in range(12)]
    cells += [(50 + k, c, r) for k in range(50) for c in range(12) for r in range(2)]
    text = "\n".join(["frame,x_mm,y_mm,kpa", *(f"{k},{5 * c},{10 * r},9" for k, c, r in cells)])
    with pytest.raises(DataError, match="lie in one row and later ones do not"):
        frames_of(write(tmp_path, text))


# -- where the grid lies -----------------------------------------------------------------------


def of_block(row: int, column: int) -> str:
    """Return a table of 3 x 2 cells alone, of a pad of 5 mm with its first centre at (100, -20)."""
    cells = [(k, column + c, row + r) for k in range(3) for r in range(3) for c in range(2)]
    lines = [f"{k},{100 + 5 * c},{-20 + 5 * r},{50 + k}" for k, c, r in cells]
    return "\n".join(["frame,x_mm,y_mm,pressure_kpa", *lines])


@pytest.mark.parametrize(("row", "column"), [(0, 0), (3, 5), (7, 2)])
def test_cells_lie_where_their_lengths_say_whatever_else_is_listed(
    row: int, column: int, tmp_path: Path
) -> None:
    path = write(tmp_path, of_block(row, column))
    image = frames_of(path)[0][0].image
    assert image.shape == (3, 2)
    corner = (10 + 0.5 * column - 0.25, -2 + 0.5 * row - 0.25)
    assert image.origin_cm == pytest.approx(corner)
    assert frames_of(path, origin_cm=(0.0, 0.0))[0][0].image.origin_cm == (0.0, 0.0)
    turned = frames_of(path, transpose=True)[0][0].image
    assert turned.origin_cm == pytest.approx(corner[::-1])
    assert frames_of(path, flip="both")[0][0].image.origin_cm == pytest.approx(corner)


def test_a_told_pitch_keeps_the_first_centre_where_it_is_stated(tmp_path: Path) -> None:
    path = write(tmp_path, of_block(0, 0))
    image = frames_of(path, pitch_cm=(0.6, 0.4))[0][0].image
    assert image.origin_cm == pytest.approx((9.7, -2.2))
    turned = frames_of(path, pitch_cm=(0.6, 0.4), transpose=True)[0][0].image
    assert turned.origin_cm == pytest.approx((-2.3, 9.8))


def test_positions_in_no_unit_of_length_say_no_origin(tmp_path: Path) -> None:
    path = write(tmp_path, placed("frame,x,y,value", "{k},{c}.5,{r}.5,{v}"))
    assert frames_of(path)[0][0].image.origin_cm == (0.0, 0.0)


def test_cells_that_lie_anywhere_are_to_be_resampled(tmp_path: Path) -> None:
    places = np.random.default_rng(0).uniform(0, 90, (40, 2))
    lines = [f"{k},{i},{x:.2f},{y:.2f},220.5" for k in range(5) for i, (x, y) in enumerate(places)]
    path = write(tmp_path, "\n".join(["frame,taxel,x_mm,y_mm,value", *lines]) + "\n")
    with pytest.raises(DataError, match=r"no places on a grid; .* resample each frame to a grid"):
        frames_of(path)
