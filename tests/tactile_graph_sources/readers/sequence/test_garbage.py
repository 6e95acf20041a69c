"""Garbage among frames is left out and told; what presses on a pad never is."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from helpers_dialects import film, flat
from helpers_recordings import frames_of, write
from tactile_graph import Frame
from tactile_graph.steps import Report
from tactile_graph_sources.readers.sequence.garbage import (
    _middle,
    coherence,
    is_garbage,
    without_garbage,
)
from tactile_graph_sources.recording import recording
from tactile_graph_sources.writers.write_npz import write_npz

FILM = film(20, 8, 8)
RNG = np.random.default_rng(0)


@pytest.mark.parametrize("at", [0, 1, 9, 19])
def test_a_frame_of_garbage_is_left_out_told_and_leaves_a_gap(at: int, tmp_path: Path) -> None:
    values = FILM.copy()
    values[at] = RNG.integers(0, 65536, (8, 8))
    path = write(tmp_path, flat(values, header=",".join(f"v{k}" for k in range(64))))
    frames, report = frames_of(path)
    np.testing.assert_array_equal([f.image.values for f in frames], np.delete(FILM, at, axis=0))
    assert report.counts["frames of garbage left out"] == 1
    assert report.troubles[0][0] == f"{path}: frame {at}"
    assert [f.index for f in frames if f.gap] == ([at] if at < 19 else [])


def test_a_first_frame_of_full_scale_is_garbage() -> None:
    frames = [Frame.of(np.full((8, 8), 4095.0)), *(Frame.of(v) for v in FILM)]
    assert len(list(without_garbage(iter(frames), Report(), "a"))) == 20


@pytest.mark.parametrize("load", [1.0, 25.0, 1000.0])
def test_what_lies_in_a_patch_is_kept_however_heavy_and_short(load: float) -> None:
    y, x = np.mgrid[:8, :8]
    press = 20.0 + load * 100.0 * np.exp(-((y - 3) ** 2 + (x - 4) ** 2) / 6.0)
    still = [np.full((8, 8), 20.0) + RNG.normal(size=(8, 8)) for _ in range(9)]
    for at in range(10):
        frames = [Frame.of(v) for v in [*still[:at], press, *still[at:]]]
        assert len(list(without_garbage(iter(frames), Report(), "a"))) == 10


def test_one_cell_pressed_for_one_frame_is_kept() -> None:
    values = np.zeros((9, 16, 16))
    values[4, 7, 7] = 900.0
    frames = [Frame.of(v) for v in values]
    assert len(list(without_garbage(iter(frames), Report(), "a"))) == 9


def test_unlike_frames_are_no_film_and_all_kept() -> None:
    frames = [Frame.of(RNG.integers(0, 4096, (8, 8)).astype(float)) for _ in range(12)]
    assert len(list(without_garbage(iter(frames), Report(), "a"))) == 12


def test_sensors_that_take_turns_are_held_against_themselves() -> None:
    frames = []
    for k, values in enumerate(FILM):
        frames += [Frame.of(values, index=2 * k, label="left")]
        frames += [Frame.of(RNG.integers(0, 9, (8, 8)), index=2 * k + 1, label="right")]
    kept = list(without_garbage(iter(frames), Report(), "a"))
    assert [f.index for f in kept] == list(range(40))


def test_frames_with_truth_and_too_few_frames_are_left_alone(tmp_path: Path) -> None:
    values = FILM.copy()
    values[0] = RNG.integers(0, 65536, (8, 8))
    write_npz(tmp_path / "a.npz", [Frame.of(v, truth=()) for v in values])
    assert len(list(recording(path=tmp_path / "a.npz", report=Report()))) == 20
    assert not is_garbage(Frame.of(values[0]), [Frame.of(v) for v in FILM[1:3]])


def test_coherence_is_that_of_patches_and_of_chance() -> None:
    y, x = np.mgrid[:16, :16]
    assert coherence(np.exp(-((y - 8.0) ** 2 + (x - 8.0) ** 2) / 20.0)) > 0.9
    assert abs(coherence(RNG.normal(size=(64, 64)))) < 0.1
    assert coherence(np.ones((4, 4))) == 1.0


@pytest.mark.parametrize("dtype", ["f8", "f4", "u1", "i2"])
@pytest.mark.parametrize("n", [3, 4, 5, 6])
def test_the_usual_frame_is_the_median_to_the_last_bit(n: int, dtype: str) -> None:
    frames = (np.random.default_rng(n).normal(100.0, 40.0, (n, 9, 7)).clip(0, 255)).astype(dtype)
    expected = np.median(frames, axis=0)
    found = _middle(frames)
    assert found.dtype == expected.dtype
    assert found.tobytes() == expected.tobytes()
