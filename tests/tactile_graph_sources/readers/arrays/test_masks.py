"""A boolean array beside frames says which of their cells are good, or is asked about."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from helpers_dialects import OBLONG
from helpers_recordings import frames_of, npz_bytes, write
from tactile_graph.errors import DataError

GOOD = np.indices(OBLONG.shape[1:]).sum(axis=0) > 2
ODD = np.where(GOOD, OBLONG, 60_000.0)


@pytest.mark.parametrize("dtype", ["f8", "f4", "u2", "i4"])
@pytest.mark.parametrize(("name", "good"), [("valid", True), ("invalid", False), ("bad", False)])
@pytest.mark.parametrize("of_each", [False, True])
def test_cells_that_are_none_are_left_out(
    of_each: bool, name: str, good: bool, dtype: str, tmp_path: Path
) -> None:
    mask = np.broadcast_to(GOOD, OBLONG.shape) if of_each else GOOD
    path = write(tmp_path, npz_bytes(frames=ODD.astype(dtype), **{name: mask == good}))
    for settings in ({}, {"sensor": "frames"}):
        frames, report = frames_of(path, **settings)
        assert all((f.image.valid == GOOD).all() for f in frames)
        np.testing.assert_array_equal([f.image.values[GOOD] for f in frames], OBLONG[:, GOOD])
        assert report.counts[f"recordings with cells left out of which array {name!r} says so"] == 1


def test_cells_of_frames_along_the_last_axis_are_left_out(tmp_path: Path) -> None:
    last = np.moveaxis(ODD, 0, -1)
    path = write(tmp_path, npz_bytes(frames=last, time_s=0.02 * np.arange(12), valid=GOOD))
    assert all((f.image.valid == GOOD).all() for f in frames_of(path)[0])


@pytest.mark.parametrize("stack", ["frames", "values"])
def test_what_a_mask_means_by_true_is_asked(stack: str, tmp_path: Path) -> None:
    path = write(tmp_path, npz_bytes(mask=~GOOD, **{stack: ODD}))
    with pytest.raises(DataError, match=r"'mask' \(6, 10\) .*valid=mask\), or valid=~mask"):
        frames_of(path)


def test_a_mask_is_passed_by_where_the_frames_are_named(tmp_path: Path) -> None:
    frames, report = frames_of(write(tmp_path, npz_bytes(frames=ODD, mask=GOOD)), sensor="frames")
    np.testing.assert_array_equal([f.image.values for f in frames], ODD)
    assert report.counts["recordings with array 'mask' left out"] == 1


N = len(OBLONG)
ROWS, COLUMNS = GOOD.shape
IN_A_ROW = {"rows": ROWS, "columns": COLUMNS}


@pytest.mark.parametrize("dtype", [bool, np.uint8])
@pytest.mark.parametrize(
    ("shape", "settings"),
    [
        ((N, ROWS * COLUMNS), {}),
        ((ROWS * COLUMNS,), {}),
        ((1, ROWS, COLUMNS), {}),
        ((ROWS, COLUMNS), {}),
        ((ROWS * COLUMNS,), IN_A_ROW),
        ((ROWS, COLUMNS), IN_A_ROW),
        ((N, ROWS, COLUMNS), IN_A_ROW),
    ],
)
def test_a_mask_may_lie_in_a_row_or_as_matrices(
    shape: tuple[int, ...], settings: dict[str, int], dtype: type, tmp_path: Path
) -> None:
    n = N if shape[0] == N else 1
    frames = ODD.reshape(N, -1) if settings else ODD
    mask = np.broadcast_to(GOOD.ravel(), (n, GOOD.size)).reshape(shape).astype(dtype)
    for name, given in (("valid", mask), ("invalid_cells", 1 - mask.astype(np.uint8))):
        path = write(tmp_path, npz_bytes(frames=frames, **{name: given}))
        read = frames_of(path, **settings)[0]
        assert all((f.image.valid == GOOD).all() for f in read)
        np.testing.assert_array_equal([f.image.values[GOOD] for f in read], OBLONG[:, GOOD])


def test_a_mask_of_cells_that_come_column_by_column_is_laid_as_they_are(tmp_path: Path) -> None:
    frames = ODD.transpose(0, 2, 1).reshape(N, -1)
    path = write(tmp_path, npz_bytes(frames=frames, valid=GOOD.T.ravel()))
    read = frames_of(path, **IN_A_ROW, order="columns")[0]
    assert all((f.image.valid == GOOD).all() for f in read)
    np.testing.assert_array_equal([f.image.values[GOOD] for f in read], OBLONG[:, GOOD])


def test_a_mask_with_a_value_for_each_frame_is_of_all_its_cells(tmp_path: Path) -> None:
    good = np.arange(N) % 3 > 0
    path = write(tmp_path, npz_bytes(frames=OBLONG, valid=good))
    found = [f.image.valid for f in frames_of(path)[0]]
    assert [valid is None for valid in found] == good.tolist()
    assert not any(valid.any() for valid in found if valid is not None)


@pytest.mark.parametrize("shape", [(N - 1,), (N - 1, ROWS, COLUMNS), (COLUMNS,), (ROWS, 2)])
def test_a_mask_of_no_frame_and_no_cell_is_refused(shape: tuple[int, ...], tmp_path: Path) -> None:
    path = write(tmp_path, npz_bytes(frames=OBLONG, valid=np.ones(shape, bool)))
    with pytest.raises(DataError) as error:
        frames_of(path)
    told = f"array 'valid' {shape} is of neither frames nor cells, of array 'frames' ("
    assert f"{told}{N} frames of {ROWS} x {COLUMNS})" in str(error.value)
    frames, report = frames_of(path, sensor="frames")
    np.testing.assert_array_equal([f.image.values for f in frames], OBLONG)
    assert report.counts["recordings with array 'valid' left out"] == 1


def test_a_mask_that_may_be_of_frames_or_of_cells_is_refused(tmp_path: Path) -> None:
    frames = np.random.default_rng(0).normal(size=(12, 3, 4))
    path = write(tmp_path, npz_bytes(frames=frames, valid=np.arange(12) > 3))
    with pytest.raises(DataError, match=r"'valid' \(12,\) may be of frames or of cells"):
        frames_of(path)


@pytest.mark.parametrize("name", ["bad", "valid"])
@pytest.mark.parametrize("given", [[0], [1], [0, 1], [1, 0, 1]])
def test_numbers_in_a_row_that_fit_neither_frames_nor_cells_are_told_and_passed_by(
    name: str, given: list[int], tmp_path: Path
) -> None:
    """A list of the cells 0 and 1 looks like a mask."""
    path = write(tmp_path, npz_bytes(frames=OBLONG, **{name: np.array(given, np.uint8)}))
    frames, report = frames_of(path)
    np.testing.assert_array_equal([f.image.values for f in frames], OBLONG)
    assert all(f.image.valid is None for f in frames)
    assert f"recordings with array {name!r} left out" in report.assumed


@pytest.mark.parametrize("shape", [(0,), (0, ROWS, COLUMNS), (0, 2)])
@pytest.mark.parametrize("dtype", [bool, np.uint8])
def test_a_mask_of_nothing_says_nothing(
    shape: tuple[int, ...], dtype: type, tmp_path: Path
) -> None:
    frames, report = frames_of(
        write(tmp_path, npz_bytes(frames=OBLONG, bad=np.zeros(shape, dtype)))
    )
    np.testing.assert_array_equal([f.image.values for f in frames], OBLONG)
    assert not any("'bad'" in text for text in report.counts)


def test_numbers_that_are_no_yes_and_no_are_no_mask(tmp_path: Path) -> None:
    for name, given in (("bad", np.array([3, 17])), ("valid", np.arange(N, dtype=np.uint8))):
        read = frames_of(write(tmp_path, npz_bytes(frames=OBLONG, **{name: given})))[0]
        np.testing.assert_array_equal([f.image.values for f in read], OBLONG)
    path = write(tmp_path, npz_bytes(mask=np.stack([GOOD] * 5), ground=OBLONG[0]))
    with pytest.raises(DataError, match="several arrays could be it"):
        frames_of(path)
