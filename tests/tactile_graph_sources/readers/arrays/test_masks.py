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
