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
