"""Recordings whose readings fall under pressure, turned round as they are read."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tactile_graph import load
from tactile_graph.errors import PipelineError
from tactile_graph.steps import Report
from tactile_graph.wires import Frame
from tactile_graph.wires.frame_stack import FrameStack
from tactile_graph_sources.readers.sequence.in_ranges import ranges_of_recordings
from tactile_graph_sources.recording import recording
from tactile_graph_sources.turned_round import inverted
from tactile_graph_sources.writers.write_npz import write_npz


def fallen(path: Path, kind: str) -> np.ndarray:
    """Write whole numbers around 4000, and fewer where pressed."""
    values = np.random.default_rng(0).normal(4000.0, 2.0, (30, 6, 7)).round()
    values[10:, 2:4, 2:5] -= 900.0
    np.save(path, values.astype(kind))
    return values


@pytest.mark.parametrize("kind", ["u2", "i4", "f4", "f8"])
def test_values_are_taken_from_what_is_told(tmp_path: Path, kind: str) -> None:
    values = fallen(tmp_path / "a.npy", kind)
    frames = [*recording(path=tmp_path / "a.npy", invert_from=4095.0, report=Report())]
    np.testing.assert_array_equal([f.image.values for f in frames], 4095.0 - values)
    assert [f.index for f in frames] == [*range(30)]


@pytest.mark.slow
def test_stacks_hold_the_same_and_no_range_of_frames_is_read_past_it(tmp_path: Path) -> None:
    values = fallen(tmp_path / "a.npy", "u2")
    told = {"path": tmp_path / "a.npy", "invert_from": 0.0}
    pipeline = load("circle-1").with_source("recording", **told)
    for some in (pipeline.frames(0, Report()), pipeline.frames_in_stacks(0, Report())):
        one_by_one = [
            f for each in some for f in (each if isinstance(each, FrameStack) else [each])
        ]
        np.testing.assert_array_equal([f.image.values for f in one_by_one], -values)
    assert ranges_of_recordings(**told) is None
    assert ranges_of_recordings(path=told["path"], invert_from=None) is not None


def test_invalid_cells_stay_invalid_and_masks_as_they_are(tmp_path: Path) -> None:
    values = np.array([[1.0, np.nan], [3.0, 4.0]])
    write_npz(tmp_path / "a.npz", [Frame.of(values)])
    (frame,) = recording(path=tmp_path / "a.npz", invert_from=10.0, report=Report())
    np.testing.assert_array_equal(frame.image.filled(np.nan), 10.0 - values)
    mask = Frame.of(np.eye(2), quantity="binary")
    assert inverted(mask, 10.0) is mask


@pytest.mark.parametrize("wrong", ["all", float("inf")])
def test_what_is_no_number_is_refused(tmp_path: Path, wrong: object) -> None:
    with pytest.raises(PipelineError, match="invert_from"):
        load("circle-1").with_source("recording", path=tmp_path / "a.npy", invert_from=wrong)
