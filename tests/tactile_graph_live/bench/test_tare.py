"""What the empty pad reads, taken off."""

from __future__ import annotations

import time

import numpy as np
import pytest

from tactile_graph import Frame, Image
from tactile_graph_live.bench import tare
from tactile_graph_live.bench.tare import Taring, less


def frame(value: float, valid: list[list[bool]] | None = None) -> Frame:
    mask = None if valid is None else np.array(valid)
    return Frame(Image(np.array([[value, 2 * value]]), valid=mask), 4, 1.5)


def test_the_baseline_is_the_median_of_each_cell() -> None:
    taring = Taring()
    for i in range(tare.N_FRAMES - 1):
        assert taring.add(frame(float(i % 3))) is None
    baseline = taring.add(frame(1000.0))
    assert baseline is not None
    assert baseline.tolist() == [[1.0, 2.0]]


def test_missing_cells_are_none_of_the_baseline() -> None:
    taring = Taring()
    for i in range(tare.N_FRAMES):
        baseline = taring.add(frame(1.0, [[i > 20, False]]))
    assert baseline is not None
    got = less(frame(3.0), baseline).image
    assert got.values.tolist() == [[2.0, 0.0]]
    assert got.valid is not None
    assert got.valid.tolist() == [[True, False]]


def test_a_slow_pad_is_tared_by_what_came_in_a_second() -> None:
    taring = Taring()
    assert taring.add(frame(1.0)) is None
    taring._since -= 2 * tare.LONGEST_S
    assert taring.add(frame(1.0)) is None
    assert taring.add(frame(4.0)) is not None


def test_the_second_of_a_slow_pad_begins_with_its_first_frame(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    taring = Taring()
    now = time.perf_counter() + 2 * tare.LONGEST_S
    monkeypatch.setattr(time, "perf_counter", lambda: now)
    assert all(taring.add(frame(1.0)) is None for _ in range(tare.FEWEST + 1))


def test_a_frame_less_the_baseline_keeps_all_but_its_values() -> None:
    got = less(frame(3.0, [[True, False]]), np.array([[1.0, 1.0]]))
    assert got.image.values.tolist() == [[2.0, 0.0]]
    assert (got.index, got.time_s) == (4, 1.5)


def test_a_frame_of_another_shape_stays_as_it_is() -> None:
    given = frame(3.0)
    assert less(given, np.zeros((2, 2))) is given
    assert less(given, None) is given
