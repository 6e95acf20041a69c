"""Cells that hold one number in every frame, which may stand for no reading."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from helpers_recordings import frames_of, write
from tactile_graph.steps import Report
from tactile_graph_sources.recording import recording

NO_SENSOR = np.zeros((6, 4), dtype=bool)
NO_SENSOR[[0, 0, 5], [0, 3, 0]] = True
LOADED = np.random.default_rng(0).uniform(0, 100, (5, 6, 4)).round(1)


def text(frames: np.ndarray) -> str:
    return "".join("\n".join(",".join(f"{v:g}" for v in r) for r in f) + "\n\n" for f in frames)


def told(report: Report) -> list[str]:
    return [what for what in report.counts if "missing=" in what]


@pytest.mark.parametrize("number", [-1.0, -2.0, -1000.0, 65535.0])
def test_a_number_for_no_sensor_is_told_and_taken_for_missing_where_it_is_said(
    number: float, tmp_path: Path
) -> None:
    path = write(tmp_path, text(np.where(NO_SENSOR, number, LOADED)))
    frames, report = frames_of(path)
    assert told(report) == [
        f"recordings with 3 cells that read {number:g} in every frame "
        f"(give missing={number:g} if there is no sensor)"
    ]
    assert all(frame.image.valid is None for frame in frames)
    frames, report = frames_of(path, missing=number)
    assert not told(report)
    for frame, true in zip(frames, LOADED, strict=True):
        assert np.array_equal(frame.image.valid, ~NO_SENSOR)
        assert np.array_equal(frame.image.values, np.where(NO_SENSOR, 0.0, true))


@pytest.mark.parametrize(
    "frames",
    [
        LOADED,
        np.where(NO_SENSOR & (np.arange(5) < 4)[:, None, None], -1.0, LOADED),
        np.where(NO_SENSOR, -np.arange(1.0, 6.0)[:, None, None], LOADED),
        np.where(np.random.default_rng(1).random((5, 6, 4)) < 0.3, -1.0, LOADED),
        LOADED - 50.0,
        np.where(NO_SENSOR, -1.0, LOADED)[:1],
        np.full((5, 6, 4), -1.0),
        np.where(NO_SENSOR, np.where(np.arange(4) < 3, -1.0, -2.0), LOADED),
    ],
    ids=["none", "not in all", "not the same", "noise", "tared", "one frame", "all", "two numbers"],
)
def test_readings_below_zero_are_readings(frames: np.ndarray, tmp_path: Path) -> None:
    _, report = frames_of(write(tmp_path, text(frames)), rows=6, columns=4)
    assert not told(report)


def test_a_number_that_is_taken_for_missing_is_told_once(tmp_path: Path) -> None:
    _, report = frames_of(write(tmp_path, text(np.where(NO_SENSOR, -9999.0, LOADED))))
    assert "cells of -9999 taken for missing" in " ".join(report.counts)
    assert not told(report)


@pytest.mark.parametrize("last", [LOADED, np.where(NO_SENSOR, -1.0, LOADED)])
def test_a_number_is_told_of_all_files_of_a_recording(last: np.ndarray, tmp_path: Path) -> None:
    folder = tmp_path / "frames"
    folder.mkdir()
    frames = [*np.where(NO_SENSOR, -1.0, LOADED)[:4], last[4]]
    for k, frame in enumerate(frames):
        rows = "\n".join(",".join(f"{v:g}" for v in row) for row in frame)
        (folder / f"frame_{k}.csv").write_text(rows + "\n")
    found, report = frames_of(folder, rows=6, columns=4)
    assert len(found) == 5
    assert bool(told(report)) is (last is not LOADED)


@pytest.mark.parametrize("in_stacks", [False, True])
def test_missing_is_obeyed_in_arrays(in_stacks: bool, tmp_path: Path) -> None:
    np.save(tmp_path / "a.npy", np.where(NO_SENSOR, -1.0, LOADED))
    report = Report()
    names = "frame_column", "time_column", "value_column", "cells", "time_unit", "time_format"
    asked = dict.fromkeys(names, "") | {"rows": 6, "columns": 4}
    read = recording.stacked if in_stacks else recording  # type: ignore[attr-defined]
    found = [*read(path=tmp_path / "a.npy", missing=-1.0, report=report, **asked)]
    assert len(found) == len(LOADED)
    assert all(np.array_equal(frame.image.valid, ~NO_SENSOR) for frame in found)
    ranges = recording.ranges  # type: ignore[attr-defined]
    assert ranges(path=tmp_path / "a.npy", missing=-1.0) is None
