"""Times that go back or leap are told; those of devices that pause are not mended."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from helpers_recordings import frames_of, write
from tactile_graph import Frame
from tactile_graph.steps import Report
from tactile_graph.wires.frame_stack import FrameStack
from tactile_graph.wires.stacks import ImageStack
from tactile_graph_sources.inspection.measure import measure
from tactile_graph_sources.readers.sequence.leaps import stacks_with_leaps_told


def _recorded(folder: Path, times_s: list[float]) -> Path:
    header = "time_s," + ",".join(f"r{i}c{j}" for i in range(3) for j in range(3))
    lines = (f"{t},{','.join(['5'] * 9)}" for t in times_s)
    return write(folder, "\n".join([header, *lines]) + "\n")


def test_a_frame_whose_time_goes_back_is_told_and_follows_a_gap(tmp_path: Path) -> None:
    frames, report = frames_of(_recorded(tmp_path, [0.0, 0.02, 0.04, 0.06, 0.01, 0.03]))
    assert [f.gap for f in frames] == [False, False, False, False, True, False]
    assert report.counts["frames whose time goes back"] == 1
    assert "its time goes back from 0.06 to 0.01 s" in report.troubles[0][1]


def test_time_that_leaps_ahead_is_counted_and_no_gap(tmp_path: Path) -> None:
    frames, report = frames_of(_recorded(tmp_path, [0.0, 0.02, 0.04, 0.06, 5.0, 5.02]))
    assert not any(f.gap for f in frames)
    assert not report.troubles
    assert report.counts["leaps in time of more than 20 usual steps"] == 1


def test_times_that_repeat_are_counted_of_frames_and_of_stacks(tmp_path: Path) -> None:
    times = [0.0, 0.0, 0.02, 0.02, 0.04, 0.04]
    _, report = frames_of(_recorded(tmp_path, times))
    assert report.counts["frames at the very time of the one before"] == 3
    assert not report.troubles
    images = ImageStack(np.ones((6, 3, 3)), (1.0, 1.0), (0.0, 0.0), "raw")
    stack, told = FrameStack(images, np.arange(6), np.array(times)), Report()
    assert len([*stacks_with_leaps_told(iter([stack]), told, "")]) == 6
    assert told.counts["frames at the very time of the one before"] == 3


def test_even_times_are_not_spoken_of(tmp_path: Path) -> None:
    _, report = frames_of(_recorded(tmp_path, [0.02 * k for k in range(30)]))
    assert not [what for what in report.counts if "time" in what]


def test_leaps_are_measured_and_the_time_taken_is_from_first_to_last() -> None:
    times = [0.0, 0.02, 0.04, 0.06, 5.0, 5.02, 0.5]
    measured = measure([Frame.of(np.eye(3), 1.0, index=k, time_s=t) for k, t in enumerate(times)])
    assert (measured.n_leaps, measured.duration_s) == (2, 5.02)


def test_frames_without_a_time_are_counted_where_others_have_one(tmp_path: Path) -> None:
    path, times = tmp_path / "some.npz", np.array([np.nan, 0.0, 0.1, np.nan, 0.3])
    np.savez(path, frames=np.ones((5, 3, 3)), time_s=times)
    frames, report = frames_of(path)
    assert report.counts["frames without a time, among others that have one"] == 2
    assert (measure(frames).rate_hz, measure(frames).duration_s) == pytest.approx((10.0, 0.3))
    np.savez(path, frames=np.ones((5, 3, 3)), time_s=np.full(5, np.nan))
    assert not [what for what in frames_of(path)[1].counts if "without a time" in what]


def test_the_time_taken_is_what_passed_where_recordings_were_joined() -> None:
    times = [100.0, 100.1, 100.2, 0.0, 0.1, 0.2]
    measured = measure([Frame.of(np.eye(3), 1.0, index=k, time_s=t) for k, t in enumerate(times)])
    assert measured.duration_s == pytest.approx(0.4)
