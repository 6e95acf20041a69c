"""The number of the first row and column, where frames list but a few cells."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from helpers_recordings import blobs, flat_text, frames_of, npy_bytes, write
from tactile_graph.errors import DataError
from tactile_graph_sources.recording import recording

ASSUMED = "recordings with rows and columns counted from 1, as none is 0 (give first_cell)"


def listed(*corners: tuple[int, int]) -> str:
    """Return a table that lists 3 x 2 cells a frame alone, the first of them at ``corners``."""
    cells = [(k, y + r, x + c) for k, (y, x) in enumerate(corners) for r, c in np.ndindex(3, 2)]
    return "\n".join(["frame,row,col,value", *(f"{k},{r},{c},50" for k, r, c in cells)])


def corner(path: Path, **told: Any) -> tuple[tuple[int, int], bool]:
    """Return the first loaded cell of the last frame, and whether the base was assumed."""
    frames, report = frames_of(path, **told)
    image = frames[-1].image
    on = (image.values > 0) & (True if image.valid is None else image.valid)
    row, column = np.argwhere(on)[0].tolist()
    return (row, column), ASSUMED in report.counts


@pytest.mark.parametrize(
    ("corners", "told", "found", "assumed"),
    [
        ([(3, 3), (5, 6)], {}, (4, 5), True),
        ([(0, 3), (5, 6)], {}, (5, 6), False),
        ([(3, 3), (5, 6)], {"first_cell": 0}, (5, 6), False),
        ([(3, 3), (5, 6)], {"first_cell": 1}, (4, 5), False),
        ([(3, 3), (5, 6)], {"rows": 7, "columns": 9}, (4, 5), False),
        ([(3, 3), (5, 6)], {"rows": 9, "columns": 7}, (4, 5), False),
        ([(3, 3), (5, 6)], {"rows": 9, "columns": 9}, (4, 5), True),
        ([(3, 3), (5, 6)], {"rows": 9, "columns": 9, "first_cell": 0}, (5, 6), False),
    ],
)
def test_what_is_listed_moves_no_cell_unless_it_is_told(
    corners: list[tuple[int, int]],
    told: dict[str, int],
    found: tuple[int, int],
    assumed: bool,
    tmp_path: Path,
) -> None:
    assert corner(write(tmp_path, listed(*corners)), **told) == (found, assumed)


@pytest.mark.parametrize("first", [0, 1])
def test_of_a_whole_grid_nothing_is_assumed(first: int, tmp_path: Path) -> None:
    values = blobs(3, 6, 7)
    cells = [f"{k},{r + first},{c + first},{v}" for (k, r, c), v in np.ndenumerate(values)]
    frames, report = frames_of(write(tmp_path, "\n".join(["frame,row,col,adc", *cells])))
    np.testing.assert_array_equal([f.image.values for f in frames], values)
    assert ASSUMED not in report.counts


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (listed((0, 3), (5, 6)), "there are cells in row or column 0"),
        (listed((3, 3)).replace("row,col", "y_mm,x_mm"), "are positions, no numbers"),
        (flat_text(blobs(3, 8, 8)), "no table of one cell a line"),
        (npy_bytes(blobs(3, 8, 8)), "no table of one cell a line"),
    ],
)
def test_a_first_cell_that_cannot_be_is_refused(
    text: str | bytes, said: str, tmp_path: Path
) -> None:
    path = write(tmp_path, text)
    with pytest.raises(DataError, match=f"first_cell.*{said}.*leave it out"):
        frames_of(path, first_cell=1)
    assert recording.ranges(path=path, first_cell=0) is None  # type: ignore[attr-defined]
