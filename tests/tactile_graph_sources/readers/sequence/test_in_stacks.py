"""Recordings in stacks hold the frames that they hold one after the other."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from tactile_graph import load
from tactile_graph.engine.blocks.gathering import flat
from tactile_graph.steps import Report
from tactile_graph.testing.same import same
from tactile_graph.wires.frame_stack import FrameStack

Values = NDArray[np.float64]


def film(n: int) -> Values:
    """Return frames of a patch that comes, moves a little and goes."""
    rng = np.random.default_rng(5)
    values = rng.normal(0.0, 1e-3, (n, 8, 9))
    values[n // 3 :, 2:6, 3:7] += np.linspace(0.2, 1.0, n - n // 3)[:, None, None]
    return values


def with_garbage(values: Values) -> None:
    values[700] = np.random.default_rng(6).random((8, 9))


def with_a_broken_cell(values: Values) -> None:
    values[600, 2, 3] = np.nan


def with_jumps(values: Values) -> None:
    values[100:110, 1:5, 1:5] += 2.0
    values[510:515] = values[509]


CHANGES: list[Callable[[Values], None]] = [
    lambda values: None,
    with_garbage,
    with_a_broken_cell,
    with_jumps,
]


def read(path: Path, in_stacks: bool, **settings: Any) -> tuple[list[Any], Report]:
    report = Report()
    pipeline = load("circle-1").with_source("recording", path=path, **settings)
    frames = pipeline.frames_in_stacks if in_stacks else pipeline.frames
    return [*frames(0, report)], report


@pytest.mark.slow
@pytest.mark.parametrize("change", CHANGES)
@pytest.mark.parametrize("n", [3, pytest.param(515, marks=pytest.mark.slow), 1100])
def test_frames_and_what_is_said_of_them_are_the_same(
    n: int, change: Callable[[Values], None], tmp_path: Path
) -> None:
    values = film(max(n, 701))
    change(values)
    path = tmp_path / "film.npz"
    rest = {"quantity": "volt", "pitch_cm": np.array([1.3, 0.7]), "time_s": np.arange(n) * 0.1}
    np.savez(path, values=values[:n], **rest)
    stacks, report = read(path, True)
    frames, expected = read(path, False)
    assert same([*flat(stacks)], frames)
    assert [f.index for f in flat(stacks)] == [*range(len(frames))]
    assert (report.counts, report.troubles) == (expected.counts, expected.troubles)
    if n > 3 and change is not with_a_broken_cell:
        assert isinstance(stacks[0], FrameStack)


@pytest.mark.parametrize("settings", [{}, {"skip": 4}, {"flip": "rows"}])
def test_settings_are_heeded(settings: dict[str, Any], tmp_path: Path) -> None:
    path = tmp_path / "film.npy"
    np.save(path, film(40))
    told = {"quantity": "volt", "rows": 8, "columns": 9, **settings}
    stacks, _ = read(path, True, **told)
    frames, _ = read(path, False, **told)
    assert same([*flat(stacks)], frames)
    assert len(frames) == 40 - settings.get("skip", 0)
