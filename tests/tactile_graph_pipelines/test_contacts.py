"""``contacts`` finds as many as there are, on panels and pads it was never told the noise of."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import numpy as np
import pytest

from helpers_cli import call
from helpers_panel import panel_frames
from helpers_recordings import SHARED, shared
from tactile_graph import Frame, load
from tactile_graph.steps import Report
from tactile_graph_sources.recording import recording


def share_right(frames: Iterable[Frame]) -> float:
    """Return in which share of the frames as many are found as there are."""
    run = load("contacts").runner()
    told = [(run(frame)["contacts"].count, len(frame.truth or ())) for frame in frames]
    return float(np.mean([found == true for found, true in told]))


@pytest.mark.slow
def test_fingertips_on_a_panel_are_counted(tmp_path: Path) -> None:
    assert share_right(panel_frames(tmp_path)) >= 0.95


@pytest.mark.slow
def test_fingertips_of_people_that_no_level_was_chosen_on_are_counted() -> None:
    shared("capcontact_others")
    paths = sorted((SHARED / "capcontact_others").glob("*.npz"))
    assert share_right(recording(path=paths, report=Report())) >= 0.95


def test_dead_lines_do_not_part_a_contact() -> None:
    rng = np.random.default_rng(4)
    for dead in (4, 5, 6):
        values = rng.normal(500.0, 2.0, (16, 16))
        values[2:9, 4:12] += 300.0
        values[dead] = 0.0
        values[:, 7] = 1023.0
        frame = Frame.of(values, 1.0, quantity="counts")
        assert load("contacts").run(frame)["contacts"].count == 1


def test_the_level_taken_is_told_once(tmp_path: Path) -> None:
    np.save(tmp_path / "one.npy", np.random.default_rng(1).normal(0.0, 1.0, (2, 8, 8)))
    said = call("run", "contacts", tmp_path / "one.npy").stdout
    assert said.count("which is above the frame's own noise") == 1
    assert "assumed  footprint: cells from" in said


@pytest.mark.parametrize("first", [2.0, 100.0])
def test_levels_by_noise_and_by_a_share_of_the_peak_are_in_one_range(
    first: float, tmp_path: Path
) -> None:
    values = np.random.default_rng(1).normal(0.0, 0.1, (2, 16, 16))
    values[0, 3:7, 3:7] += first
    values[1, 3:7, 3:7] += 102.0 - first
    np.save(tmp_path / "two.npy", values)
    said = " ".join(call("run", "contacts", tmp_path / "two.npy").stdout.split())
    assert (": 3 % of the peak, as that is more" in said) is (first == 100.0)
    assert "in the frames looked at)" in said
