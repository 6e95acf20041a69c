"""Cells of several pads in one table, a line a cell: laid over each other they are no frame."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from helpers_recordings import frames_of, write
from tactile_graph.errors import DataError

PADS = {"palm": (5, 5, 6), "thumb": (2, 4, 4)}
"""Pitch in mm, rows and columns of each."""


def hand(column: str, number: bool = False, n_frames: int = 3) -> str:
    """Return a table of both pads, whose first cells lie at (0, 0)."""
    lines = [
        f"{k},{j if number else name},{mm * c},{mm * r},{10 * j + r}"
        for k in range(n_frames)
        for j, (name, (mm, rows, columns)) in enumerate(PADS.items())
        for r, c in np.ndindex(rows, columns)
    ]
    return "\n".join([f"frame,{column},x_mm,y_mm,pressure_kpa", *lines]) + "\n"


@pytest.mark.parametrize(
    "column", ["sensor", "patch", "pad", "finger", "taxel_group", "module", "Patch_ID"]
)
def test_a_column_that_is_called_so_tells_pads_apart(column: str, tmp_path: Path) -> None:
    path = write(tmp_path, hand(column))
    with pytest.raises(DataError, match=f"column '{column}' says: palm, thumb; name one with se"):
        frames_of(path)
    image = frames_of(path, sensor="thumb")[0][0].image
    assert image.shape == (4, 4)
    assert image.pitch_cm == pytest.approx((0.2, 0.2))


@pytest.mark.parametrize("number", [False, True])
def test_a_column_left_out_that_explains_cells_that_come_again_is_asked_about(
    number: bool, tmp_path: Path
) -> None:
    labels = "0, 1" if number else "palm, thumb"
    path = write(tmp_path, hand("skin", number))
    with pytest.raises(
        DataError, match=rf"cells come again .* 'skin' tells them apart \({labels}\)"
    ):
        frames_of(path)


def test_cells_that_come_again_now_and_then_are_damage(tmp_path: Path) -> None:
    lines = [f"{k},{k % 2},{c},{r},5" for k, r, c in np.ndindex(6, 4, 5)]
    lines[30:30] = ["1,0,3,1,7"]
    path = write(tmp_path, "\n".join(["frame,phase,col,row,value", *lines]))
    frames, report = frames_of(path)
    assert len(frames) == 6
    assert report.counts["repeated cells dropped"] == 1


@pytest.mark.parametrize("header", ["row,col", "y_mm,x_mm"])
@pytest.mark.parametrize("part", [lambda r, c: 2 * (r // 4) + c // 3, lambda r, c: c % 2])
def test_parts_of_one_grid_are_read_as_one_unless_one_is_asked_for(
    header: str, part: Callable[[int, int], int], tmp_path: Path
) -> None:
    values = np.arange(144.0).reshape(3, 8, 6)
    lines = [f"{k},{part(r, c)},{5 * r},{5 * c},{v}" for (k, r, c), v in np.ndenumerate(values)]
    if header == "row,col":
        lines = [f"{k},{part(r, c)},{r},{c},{v}" for (k, r, c), v in np.ndenumerate(values)]
    path = write(tmp_path, "\n".join([f"frame,module,{header},value", *lines]))
    frames, report = frames_of(path)
    np.testing.assert_array_equal([f.image.values for f in frames], values)
    assert report.counts["recordings with columns left out (module)"] == 1
    alone = frames_of(path, sensor="1")[0][0].image
    n_alone = alone.values.size if alone.valid is None else np.count_nonzero(alone.valid)
    assert n_alone == sum(part(r, c) == 1 for r, c in np.ndindex(8, 6))


@pytest.mark.parametrize("key", ["array", "patch", "values"])
def test_readings_that_come_again_name_no_sensors(key: str, tmp_path: Path) -> None:
    film = [{"t": k, key: [[k % 2, 5], [7, 9]]} for k in range(6)]
    frames, _ = frames_of(write(tmp_path, json.dumps(film), "film.json"))
    assert [f.image.values[0, 0] for f in frames] == [0, 1, 0, 1, 0, 1]
