"""Stores read in place: any range of frames, as the source itself would have given them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tactile_graph import Frame
from tactile_graph.engine.gathering import flat
from tactile_graph.steps import Report
from tactile_graph.steps.ranges import Irregular, Ranges
from tactile_graph.wires.frame_stack import FrameStack
from tactile_graph_sources.readers.in_ranges import ranges_of_recordings
from tactile_graph_sources.recording import recording, recording_stacked
from tactile_graph_sources.writers.write_store import StoreWriter

pytest.importorskip("zarr", reason="the 'zarr' extra is not installed")
pytestmark = pytest.mark.slow


def store(path: Path, n: int, garbage: tuple[int, ...] = (), pause: int | None = None) -> Path:
    path.parent.mkdir(exist_ok=True)
    rng = np.random.default_rng(n)
    frames = []
    for k in range(n):
        values = np.zeros((8, 8))
        values[2:5, 2:5] = 1.0
        values += 0.001 * rng.random((8, 8))
        if k in garbage:
            values = rng.random((8, 8)) * 5.0
        time_s = 0.1 * k + (60.0 if pause is not None and k >= pause else 0.0)
        frames.append(Frame.of(values, quantity="volt", index=k, time_s=time_s))
    with StoreWriter(path, chunk=10) as writer:
        for frame in frames:
            writer.write(frame)
    return path


def ranges(path: Path | list[Path], **told: Any) -> Ranges:
    found = ranges_of_recordings(path, **told)
    assert found is not None
    return found


def told(frame: Frame) -> tuple[object, ...]:
    image = frame.image
    grid = (image.pitch_cm, image.origin_cm, image.quantity)
    said = (frame.index, frame.time_s, frame.gap, frame.label)
    return (*said, *grid, image.values.flags.c_contiguous, image.values.tobytes())


@pytest.mark.parametrize("settings", [
    {}, {"skip": 7}, {"flip": "rows", "pitch_cm": (0.5, 2.0)}, {"transpose": True, "rows": 8},
], ids=str)  # fmt: skip
def test_any_range_is_what_the_source_gives(tmp_path: Path, settings: dict[str, Any]) -> None:
    paths = [store(tmp_path / "one" / "a.zarr", 23), store(tmp_path / "two" / "a.zarr", 31)]
    whole = [told(f) for f in recording(path=paths, report=Report(), **settings)]
    found = ranges(paths, **settings)
    skip = settings.get("skip", 0)
    assert found.recordings == (23 - skip, 31 - skip)
    assert found.together == 10
    for low in range(0, len(whole), 9):
        for high in (low + 1, low + 13, len(whole)):
            read = [told(f) for f in found.read(low, min(high, len(whole)))]
            assert read == whole[low:high]


@pytest.mark.parametrize("settings", [{}, {"skip": 7}, {"flip": "rows"}], ids=str)
def test_stacks_hold_the_same_frames(tmp_path: Path, settings: dict[str, Any]) -> None:
    path = store(tmp_path / "a.zarr", 73)
    whole = [told(f) for f in recording(path=path, report=Report(), **settings)]
    found = ranges(path, **settings)
    assert found.read_in_stacks is not None
    for low in range(0, len(whole), 9):
        for high in (low + 1, low + 13, len(whole)):
            read = [*found.read_in_stacks(low, min(high, len(whole)))]
            assert [told(f) for f in flat(read)] == whole[low:high]
            assert "flip" in settings or any(isinstance(some, FrameStack) for some in read)


def test_stacks_end_where_there_is_more_to_say(tmp_path: Path) -> None:
    """What is marked, damaged or garbage comes frame by frame, as without stacks."""
    path = store(tmp_path / "a.zarr", 1100, garbage=(1041,))
    (path / "values" / "c" / "107" / "0" / "0").unlink()
    reports = Report(), Report()
    one_by_one = [told(f) for f in recording(path=path, report=reports[0])]
    settings = {"frame_column": "", "value_column": "", "time_column": "", "cells": ""}
    stacks = recording_stacked(
        path=path, time_unit="", time_format="", report=reports[1], **settings
    )
    read = [*stacks]
    assert isinstance(read[0], FrameStack)
    assert [told(f) for f in flat(read)] == one_by_one
    assert reports[0].counts == reports[1].counts
    assert sorted(reports[0].troubles) == sorted(reports[1].troubles)
    assert reports[0].counts["frames of garbage left out"] == 1
    assert reports[0].counts["damaged records skipped"] == 10


def test_a_leap_in_time_makes_it_irregular_as_far_as_it_is_told(tmp_path: Path) -> None:
    found = ranges(store(tmp_path / "a.zarr", 60, pause=30))
    assert len(list(found.read(0, 25))) == 25
    with pytest.raises(Irregular, match="leaps in time"):
        list(found.read(31, 35))


def test_a_setting_that_the_frames_contradict_is_left_to_who_reads_from_the_start(
    tmp_path: Path,
) -> None:
    found = ranges(store(tmp_path / "a.zarr", 5), rows=9)
    with pytest.raises(Irregular, match="the settings say rows=9"):
        list(found.read(0, 5))


def test_settings_that_leave_frames_out_anywhere_have_no_ranges(tmp_path: Path) -> None:
    assert ranges_of_recordings(store(tmp_path / "a.zarr", 5), sensor="left") is None


def test_frames_that_are_left_out_make_it_irregular(tmp_path: Path) -> None:
    found = ranges(store(tmp_path / "a.zarr", 40, garbage=(20,)))
    assert len(list(found.read(0, 10))) == 10
    with pytest.raises(Irregular, match="garbage"):
        list(found.read(15, 25))


def test_lost_frames_make_it_irregular(tmp_path: Path) -> None:
    path = store(tmp_path / "a.zarr", 40)
    found = ranges(path)
    for part in (path / "values").rglob("*"):
        if part.is_file() and part.name != "zarr.json":
            part.unlink()
    with pytest.raises(Irregular, match="lost"):
        list(found.read(15, 25))


def test_other_files_have_no_ranges(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("1,2\n")
    assert ranges_of_recordings(tmp_path / "a.csv") is None
    assert ranges_of_recordings([store(tmp_path / "b.zarr", 5), tmp_path / "a.csv"]) is None
