"""Times beside a stack: their unit told, days, texts; settings that say nothing are refused."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from helpers_dialects import OBLONG, cell_array, matlab
from helpers_recordings import flat_text, frames_of, npy_bytes, npz_bytes, write
from tactile_graph.errors import DataError
from tactile_graph.wires import Frame
from tactile_graph_sources.writers.write_npz import write_npz

N = len(OBLONG)
LAST = np.moveaxis(OBLONG, 0, -1)
SHAPE = {"rows": 6, "columns": 10}
STAMPS = [f"2026-11-16 23:59:{58.5 + 0.1 * k:06.3f}" for k in range(N)]
DATENUM = 739937 + np.arange(N) / 864_000
AS_DATENUM = (
    "recordings with times assumed to be in days since the year 0, as MATLAB's datenum counts them"
)


def times_of(path: Path, **settings: Any) -> tuple[list[float | None], set[str]]:
    """Return the times (s) of frames from the first on, and what was told."""
    frames, report = frames_of(path, **settings)
    np.testing.assert_array_equal([f.image.values for f in frames], OBLONG)
    first = frames[0].time_s or 0.0
    return [None if f.time_s is None else f.time_s - first for f in frames], {*report.counts}


@pytest.mark.parametrize(
    "content",
    [
        npz_bytes(frames=OBLONG, time=1.0 * np.arange(N)),
        npz_bytes(frames=OBLONG, time_s=1.0 * np.arange(N)),
        npz_bytes(frames=OBLONG, time=np.arange(N).astype(str)),
        matlab(frames=LAST, t=1.0 * np.arange(N)),
        json.dumps([{"time": k, "p": f.tolist()} for k, f in enumerate(OBLONG)]),
    ],
    ids=["npz", "npz, its name says another", "npz, as texts", "matlab", "json"],
)
def test_the_unit_that_is_told_goes_before_all(content: bytes | str, tmp_path: Path) -> None:
    found, told = times_of(write(tmp_path, content), time_unit="ms")
    assert found == pytest.approx([1e-3 * k for k in range(N)])
    assert not any("times" in what for what in told)


@pytest.mark.slow
def test_the_unit_that_is_told_holds_in_hdf5_and_zarr(tmp_path: Path) -> None:
    h5py, zarr = pytest.importorskip("h5py"), pytest.importorskip("zarr")
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["p"], file["time"] = OBLONG, 1.0 * np.arange(N)
    group = zarr.open_group(str(tmp_path / "a.zarr"), mode="w")
    group.create_array("p", data=OBLONG)
    group.create_array("time", data=1.0 * np.arange(N))
    for name in ("a.h5", "a.zarr"):
        assert times_of(tmp_path / name, time_unit="min")[0] == [60.0 * k for k in range(N)]
        with pytest.raises(DataError, match=r"time_column: it has no columns, .*; leave it out$"):
            frames_of(tmp_path / name, time_column="time")


@pytest.mark.parametrize(
    ("content", "settings", "told"),
    [
        (npz_bytes(frames=OBLONG), {"cells": "2-5"}, "cells: it has no columns, as tables have"),
        (
            npy_bytes(OBLONG),
            {"time_column": "t", "value_column": "v"},
            "time_column and value_column: it has no columns, .*; leave them out$",
        ),
        (npy_bytes(OBLONG), {"time_unit": "ms"}, "time_unit: its times, if it has any, are in "),
        (json.dumps(OBLONG.tolist()), {"frame_column": "n"}, "frame_column: it has no columns"),
        (npz_bytes(frames=OBLONG, time=np.array(STAMPS)), {"time_unit": "s"}, "'time' holds texts"),
        (npz_bytes(frames=OBLONG, time=np.arange(N)), {"time_format": "%S"}, "'time' holds number"),
        (
            npz_bytes(frames=OBLONG, time=np.array(STAMPS, "M8[ms]")),
            {"time_unit": "s"},
            "'time' holds dates; leave out time_unit",
        ),
    ],
)
def test_settings_that_say_nothing_of_a_file_are_refused(
    content: bytes | str, settings: dict[str, str], told: str, tmp_path: Path
) -> None:
    with pytest.raises(DataError, match=told):
        frames_of(write(tmp_path, content), **settings)


def test_settings_pass_a_file_of_ours_by_and_are_told(tmp_path: Path) -> None:
    frames = [Frame.of(v, index=k, time_s=0.5 * k) for k, v in enumerate(OBLONG)]
    write_npz(tmp_path / "a.npz", frames)
    found, told = times_of(tmp_path / "a.npz", time_unit="ms", cells="2-61")
    assert found[2] == 1.0
    passed = "recordings with {} left out, as a file of ours says itself what it holds"
    assert {passed.format("time_unit"), passed.format("cells")} <= told
    _, told = times_of(write(tmp_path, npz_bytes(frames=OBLONG)), time_unit="ms")
    assert "recordings with no times beside the frames, so time_unit says nothing" in told


@pytest.mark.parametrize(("name", "told"), [("timestamp", {AS_DATENUM}), ("datenum", set())])
def test_days_since_the_year_0_are_times(name: str, told: set[str], tmp_path: Path) -> None:
    header = ",".join([name, *(f"r{r}c{c}" for r in range(6) for c in range(10))])
    lines = zip(DATENUM, flat_text(OBLONG).splitlines(), strict=True)
    table = "\n".join([header, *(f"{day:.9f},{line}" for day, line in lines)])
    days = {name: DATENUM}
    for content in (matlab(p=LAST, **days), npz_bytes(p=OBLONG, **days), table):
        found, said = times_of(write(tmp_path, content))
        assert found == pytest.approx([0.1 * k for k in range(N)], abs=1e-4)
        assert {what for what in said if "times" in what} == told


@pytest.mark.parametrize(
    "content",
    [
        matlab(p=LAST, time=np.array(STAMPS)),
        matlab(p=LAST, time=cell_array(STAMPS)),
        matlab(log=cell_array([{"p": f, "time": t} for f, t in zip(OBLONG, STAMPS, strict=True)])),
        npz_bytes(p=OBLONG, time=np.array(STAMPS)),
    ],
    ids=["rows of letters", "cells", "structs", "npz"],
)
def test_texts_of_dates_are_times(content: bytes, tmp_path: Path) -> None:
    found, _ = times_of(write(tmp_path, content), **SHAPE)
    assert found == pytest.approx([0.1 * k for k in range(N)])


def test_times_of_day_go_on_over_midnight(tmp_path: Path) -> None:
    clocks = np.array(["23:59:59.5", "00:00:00.5", *(f"00:00:{k:02d}.5" for k in range(1, N - 1))])
    found, _ = times_of(write(tmp_path, npz_bytes(p=OBLONG, time=clocks)))
    assert found == pytest.approx([1.0 * k for k in range(N)])


def test_texts_that_are_no_times_are_told_and_read_as_time_format_says(tmp_path: Path) -> None:
    spelled = np.array([f"16-Nov-2026 10:00:{k:02d}.000" for k in range(N)])
    path = write(tmp_path, matlab(p=LAST, time=spelled))
    found, told = times_of(path, **SHAPE)
    assert found[0] is None
    left = "times left out, as of 'time' '16-Nov-2026 10:00:00.000' is no time that is known"
    assert f"recordings with {left} (give time_format)" in told
    found, _ = times_of(path, **SHAPE, time_format="%d-%b-%Y %H:%M:%S.%f")
    assert found == [1.0 * k for k in range(N)]
    rows = [{"time": t, "p": f.tolist()} for t, f in zip(spelled.tolist(), OBLONG, strict=True)]
    found, told = times_of(write(tmp_path, json.dumps(rows)))
    assert found[0] is None
    assert any("times left out, as '16-Nov-2026" in what for what in told)


def test_times_of_a_kind_that_is_not_read_are_told(tmp_path: Path) -> None:
    path = write(tmp_path, matlab(p=LAST, time=1j * np.arange(N)))
    told = "times left out, as 'time' is complex (save it as numbers of seconds)"
    assert f"recordings with {told}" in times_of(path, **SHAPE)[1]
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["p"], file["time"] = OBLONG, 1j * np.arange(N)
    _, said = times_of(tmp_path / "a.h5")
    assert any("times left out, as 'time' is not read: (12,), complex" in what for what in said)


@pytest.mark.slow
def test_texts_of_hdf5_and_zarr_are_times(tmp_path: Path) -> None:
    h5py, zarr = pytest.importorskip("h5py"), pytest.importorskip("zarr")
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["p"], file["time"] = OBLONG, STAMPS
    group = zarr.open_group(str(tmp_path / "a.zarr"), mode="w", zarr_format=2)
    group.create_array("p", data=OBLONG)
    group.create_array("time", data=np.array(STAMPS))
    for name in ("a.h5", "a.zarr"):
        assert times_of(tmp_path / name)[0] == pytest.approx([0.1 * k for k in range(N)])


def test_words_beside_a_matrix_name_its_rows_and_are_no_times(tmp_path: Path) -> None:
    path = write(tmp_path, npz_bytes(p=OBLONG[0], time=np.array(["rest", *"abcde"])))
    frames, report = frames_of(path)
    np.testing.assert_array_equal([f.image.values for f in frames], OBLONG[:1])
    assert any("times left out, as of 'time' 'rest' is no time" in told for told in report.counts)
