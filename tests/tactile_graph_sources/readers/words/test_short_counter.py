"""A counter of 16 bits goes on over its end, and nowhere else."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from helpers_recordings import frames_of, write
from tactile_graph_sources.readers.words.short_counter import ShortCounter


def run(counts: list[float]) -> list[float]:
    counter = ShortCounter()
    return [counter.run_on(count) for count in counts]


@pytest.mark.parametrize("step", [20, 37, 5000])
def test_counts_go_on_over_the_end_however_often(step: int) -> None:
    counts = [50_000 + step * k for k in range(10_000)]
    assert run([float(c % 65_536) for c in counts]) == counts


@pytest.mark.parametrize(
    "counts",
    [
        [100.0, 120.0, 140.0, 0.0, 20.0],  # begun anew
        [65_400.0, 65_420.0, 65_440.0, 0.0, 20.0],  # more than a step before the end
        [65_516.0, 0.0, 20.0],  # no step known
        [99_960.0, 99_980.0, 100_000.0, 34_484.0],  # of more bits
    ],
)
def test_counts_that_fall_back_otherwise_stay(counts: list[float]) -> None:
    assert run(counts) == counts


def test_a_count_that_is_no_number_spoils_no_other() -> None:
    assert run([65_496.0, 65_516.0, np.nan, 65_536.0 - 1, 19.0])[-1] == 65_536.0 + 19.0


def test_a_table_of_such_milliseconds(tmp_path: Path) -> None:
    head = "time_ms," + ",".join(f"r{k // 3}c{k % 3}" for k in range(9))
    rows = (f"{(65_200 + 37 * k) % 65_536}," + "5,50,500,5,50,500,5,50,500" for k in range(20))
    frames, report = frames_of(write(tmp_path, "\n".join([head, *rows]) + "\n"))
    assert np.diff([f.time_s or 0.0 for f in frames]) == pytest.approx([0.037] * 19)
    assert not report.troubles
