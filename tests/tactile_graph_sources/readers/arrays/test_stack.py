"""Along which axis of an array the frames lie: asked, told as assumed, or known."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from helpers_dialects import matlab
from helpers_recordings import frames_of, npy_bytes, npz_bytes, write
from tactile_graph.errors import DataError
from tactile_graph.wires import Frame
from tactile_graph_sources.writers.write_npz import write_npz


def moving(n: int, rows: int, columns: int) -> np.ndarray:
    """Return a load that moves slowly over the pad, shape (n, rows, columns)."""
    y, x = np.mgrid[:rows, :columns]
    apart = [(y - rows / 4 - 0.2 * k) ** 2 + (x - columns / 1.6 + 0.3 * k) ** 2 for k in range(n)]
    return np.round(20 + (3 * x + 5 * y) % 4 + 800 * np.exp(-np.array(apart) / 9))


@pytest.mark.parametrize("shape", [(12, 9, 11), (10, 28, 56), (30, 16, 20)])
def test_frames_along_the_last_axis_are_asked_about_where_neighbours_say_so(
    shape: tuple[int, int, int], tmp_path: Path
) -> None:
    values = moving(*shape)
    path = write(tmp_path, npy_bytes(np.moveaxis(values, 0, -1)))
    n, rows, columns = shape
    with pytest.raises(DataError, match=f"{n} frames of {rows} x {columns} along the last axis"):
        frames_of(path)
    frames, _ = frames_of(path, rows=rows, columns=columns)
    np.testing.assert_array_equal([f.image.values for f in frames], values)
    frames, report = frames_of(write(tmp_path, npy_bytes(values)))
    np.testing.assert_array_equal([f.image.values for f in frames], values)
    assert not any("axis" in what for what in report.counts)


@pytest.mark.parametrize("shape", [(12, 9, 14), (5, 7, 2)])
def test_the_axis_of_frames_is_told_where_nothing_says_it(
    shape: tuple[int, int, int], tmp_path: Path
) -> None:
    noise = np.random.default_rng(0).normal(20, 1, shape)
    n, rows, columns = shape
    told = f"recordings with frames assumed to lie along the first axis, {n} of {rows} x {columns}"
    for content in (npy_bytes(noise), npz_bytes(frames=noise), npz_bytes(values=noise)):
        frames, report = frames_of(write(tmp_path, content))
        assert len(frames) == n
        assert report.counts[told] == 1
    _, report = frames_of(write(tmp_path, npy_bytes(noise)), rows=rows, columns=columns)
    assert told not in report.counts


@pytest.mark.parametrize("n", [2, 3, 4, 5])
def test_a_short_last_axis_is_asked_about_as_channels(n: int, tmp_path: Path) -> None:
    noise = np.random.default_rng(0).normal(20, 1, (48, 64, n))
    told = f"48 frames of 64 x {n}, or a picture of {n} colours or channels; .*array.mean"
    for content in (npy_bytes(noise), npz_bytes(frames=noise)):
        path = write(tmp_path, content)
        for settings in ({}, {"rows": 48, "columns": 64}):
            with pytest.raises(DataError, match=told):
                frames_of(path, **settings)
        assert len(frames_of(path, rows=64, columns=n)[0]) == 48
    frames, report = frames_of(write(tmp_path, npy_bytes(moving(30, 12, 5))))
    assert len(frames) == 30  # its neighbours along rows and columns are alike
    assert not any("assumed to lie" in what for what in report.counts)


@pytest.mark.parametrize("shape", [(200, 16, 2), (200, 6, 2), (200, 12, 5)])
def test_many_frames_of_few_columns_are_no_picture_of_channels(
    shape: tuple[int, int, int], tmp_path: Path
) -> None:
    noise = np.random.default_rng(0).normal(20, 1, shape)
    n, rows, columns = shape
    frames, report = frames_of(write(tmp_path, npy_bytes(noise)))
    np.testing.assert_array_equal([f.image.values for f in frames], noise)
    told = f"recordings with frames assumed to lie along the first axis, {n} of {rows} x {columns}"
    assert report.counts[told] == 1


@pytest.mark.parametrize("columns", [2, 3, 5])
def test_rows_or_columns_alone_tell_frames_from_channels(columns: int, tmp_path: Path) -> None:
    noise = np.random.default_rng(0).normal(20, 1, (40, 16, columns))
    path = write(tmp_path, npy_bytes(noise))
    for told in ({"rows": 16}, {"columns": columns}):
        assert [f.image.shape for f in frames_of(path, **told)[0]] == [(16, columns)] * 40
    for told in ({}, {"rows": 40}, {"columns": 16}):
        with pytest.raises(DataError, match=f"picture of {columns} colours or channels"):
            frames_of(path, **told)


@pytest.mark.parametrize(
    ("shape", "words"),
    [
        ((10, 24, 32, 3), r"array\[..., channel\] .*array\.mean\(axis=-1\)"),
        ((10, 3, 24, 32), r"array\[:, channel\] .*array\.mean\(axis=1\)"),
    ],
)
def test_of_channels_on_a_fourth_axis_one_is_to_be_chosen(
    shape: tuple[int, ...], words: str, tmp_path: Path
) -> None:
    with pytest.raises(DataError, match=words):
        frames_of(write(tmp_path, npy_bytes(np.zeros(shape))))


def test_a_matrix_is_told_as_one_where_its_lines_could_be_frames(tmp_path: Path) -> None:
    told = "recordings with 30 lines of 60 values assumed to be the rows of one matrix"
    values = np.random.default_rng(0).normal(20, 1, (30, 60))
    for content in (npy_bytes(values), npz_bytes(frames=values)):
        path = write(tmp_path, content)
        assert frames_of(path)[1].counts[told] == 1
        assert told not in frames_of(path, rows=30, columns=60)[1].counts


def test_times_say_along_which_axis_frames_lie(tmp_path: Path) -> None:
    noise = np.random.default_rng(0).normal(20, 1, (12, 9, 14))
    times = 0.02 * np.arange(12)
    told = "recordings with frames taken to lie along the last axis, as there are 12 times"
    for array, n_told in ((noise, 0), (np.moveaxis(noise, 0, -1), 1)):
        frames, report = frames_of(write(tmp_path, npz_bytes(frames=array, time_s=times)))
        np.testing.assert_array_equal([f.image.values for f in frames], noise)
        assert [f.time_s for f in frames] == pytest.approx(times.tolist())
        assert report.counts[told] == n_told
        assert not any("assumed to lie" in what for what in report.counts)


@pytest.mark.parametrize("shape", [(5, 5, 7), (6, 6, 3), (2, 2, 30)])
def test_frames_that_the_project_wrote_lie_along_the_first_axis_whatever_their_shape(
    shape: tuple[int, int, int], tmp_path: Path
) -> None:
    values = moving(*shape)
    write_npz(tmp_path / "a.npz", [Frame.of(v, index=k) for k, v in enumerate(values)])
    frames, report = frames_of(tmp_path / "a.npz")
    np.testing.assert_array_equal([f.image.values for f in frames], values)
    assert not any("axis" in what for what in report.counts)


def test_the_axis_of_frames_of_three_equal_sides_is_told(tmp_path: Path) -> None:
    noise, told = np.random.default_rng(0).normal(20, 1, (9, 9, 9)), moving(16, 16, 16)
    assumed = "recordings with frames assumed to lie along the first axis, 9 of 9 x 9"
    for content in (npy_bytes(noise), npz_bytes(frames=noise), matlab(p=noise)):
        frames, report = frames_of(write(tmp_path, content), rows=9, columns=9)
        np.testing.assert_array_equal([f.image.values for f in frames], noise)
        assert report.counts[assumed] == 1
    last = np.moveaxis(told, 0, -1)
    for content in (npy_bytes(last), npz_bytes(frames=last), matlab(p=last)):
        frames, report = frames_of(write(tmp_path, content), rows=16, columns=16)
        np.testing.assert_array_equal([f.image.values for f in frames], told)
        assert report.counts[
            "recordings with frames taken to lie along the last axis of 16, as the values say"
        ]
    with pytest.raises(DataError, match=r"put frames first, in MATLAB permute\(array, \[3 1 2\]\)"):
        frames_of(write(tmp_path, matlab(p=noise)))
