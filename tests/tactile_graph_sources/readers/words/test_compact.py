"""Dates and times of day that are written as one number, and durations as pandas writes them."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from helpers_recordings import blobs, flat_text, frames_of, npz_bytes, write
from tactile_graph.errors import DataError
from tactile_graph_sources.readers.words.compact import are_hhmmss, stamp_s, stamps_s

VALUES = blobs(12, 5, 7)
STAMPS = [20240331235954 + k if k < 6 else 20240401000000 + k - 6 for k in range(12)]


def table(stamps: list[object], name: str = "timestamp") -> str:
    """Return frames of named cells behind their stamps."""
    header = ",".join([name, *(f"r{r}c{c}" for r in range(5) for c in range(7))])
    rows = flat_text(VALUES).splitlines()
    return "\n".join([header, *(f"{s},{x}" for s, x in zip(stamps, rows, strict=True))])


@pytest.mark.parametrize(
    "form",
    [
        lambda s: s,
        lambda s: f"{str(s)[:8]}T{str(s)[8:]}",
        lambda s: f"{str(s)[:8]}_{str(s)[8:]}.5",
        lambda s: f"{s}250",
    ],
)
@pytest.mark.parametrize("name", ["timestamp", "time", "Zeit"])
def test_a_column_of_stamps_gives_times_in_seconds(
    form: Callable[[int], object], name: str, tmp_path: Path
) -> None:
    frames, report = frames_of(write(tmp_path, table([form(s) for s in STAMPS], name)))
    assert [f.time_s for f in frames] == pytest.approx(list(range(12)))
    assert not any("times assumed" in what for what in report.counts)


def test_stamps_of_other_files_give_times_in_seconds_too(tmp_path: Path) -> None:
    long = [f"{s},{r},{c},{v}" for (k, r, c), v in np.ndenumerate(VALUES) for s in [STAMPS[k]]]
    square = flat_text(blobs(12, 8, 8)).splitlines()
    rows = [{"time": s, "values": m.tolist()} for s, m in zip(STAMPS, VALUES, strict=True)]
    for name, content in {
        "long.csv": "\n".join(["time,row,col,value", *long]),
        "bare.csv": "\n".join(f"{s},{x}" for s, x in zip(STAMPS, square, strict=True)),
        "a.json": json.dumps(rows),
        "a.npz": npz_bytes(frames=VALUES, time=np.array(STAMPS)),
    }.items():
        frames, _ = frames_of(write(tmp_path, content, name))
        assert [f.time_s for f in frames] == pytest.approx(list(range(12))), name


@pytest.mark.parametrize(
    "form",
    [
        "0 days 00:00:00.{:06d}",
        "1 days 23:59:59.{:06d}",
        "-1 days +23:59:59.{:06d}",
        "1 day, 0:00:00.{:06d}",
        "P0DT0H0M0.{:06d}S",
    ],
)
@pytest.mark.parametrize("name", ["", "time"])
def test_durations_give_times(form: str, name: str, tmp_path: Path) -> None:
    stamps: list[object] = [form.format(20_000 * k) for k in range(12)]
    if "," in form:
        stamps = [f'"{s}"' for s in stamps]
    frames, report = frames_of(write(tmp_path, table(stamps, name)))
    assert [f.time_s for f in frames] == pytest.approx([0.02 * k for k in range(12)])
    assert not report.troubles
    long = [f"{stamps[k]},{r},{c},{v}" for (k, r, c), v in np.ndenumerate(VALUES)]
    frames, _ = frames_of(write(tmp_path, "\n".join(["time,row,col,value", *long])))
    assert [f.time_s for f in frames] == pytest.approx([0.02 * k for k in range(12)])


def test_times_that_nobody_knows_are_asked_about(tmp_path: Path) -> None:
    path = write(tmp_path, table([f"0h{k:02d}" for k in range(12)]))
    with pytest.raises(DataError, match=r"'timestamp' says '0h00', .* --with time_format=%H:%M:%S"):
        frames_of(path)
    frames, _ = frames_of(path, time_format="%Hh%M")
    assert [f.time_s for f in frames] == [60.0 * k for k in range(12)]
    long = [f"0h{k:02d},{r},{c},{v}" for (k, r, c), v in np.ndenumerate(VALUES)]
    path = write(tmp_path, "\n".join(["time,row,col,value", *long]))
    with pytest.raises(DataError, match="'time' says '0h00'"):
        frames_of(path)
    frames, _ = frames_of(path, time_format="%Hh%M")
    assert [f.time_s for f in frames] == [60.0 * k for k in range(12)]


def test_times_of_day_as_numbers_are_known_by_what_they_leap_by(tmp_path: Path) -> None:
    stamps: list[object] = [*range(115954, 115960), *range(120000, 120006)]
    frames, report = frames_of(write(tmp_path, table(stamps)))
    assert [f.time_s for f in frames] == pytest.approx(list(range(12)))
    told = "recordings with times taken for hours, minutes and seconds (115954)"
    assert report.counts[told] == 1
    early: list[object] = [*range(54, 60), *range(100, 106)]
    frames, _ = frames_of(write(tmp_path, table(early)))
    assert [f.time_s for f in frames] == pytest.approx(list(range(12)))


@pytest.mark.parametrize(
    "numbers",
    [
        range(115930, 115942),  # nothing contradicts seconds
        range(115954, 115966),  # a minute has no 65th second
        [*range(10, 16), *range(56, 62)],
        [*range(100, 106), *range(146, 152)],  # a pause
    ],
)
def test_whole_numbers_that_may_be_seconds_are_no_times_of_day(numbers: list[int]) -> None:
    assert not are_hhmmss(np.array(numbers, dtype=np.float64))


@pytest.mark.parametrize(
    "number", [20241331235954, 20240230120000, 20240101250000, 18000101000000, 1711929594000, 2024]
)
def test_numbers_that_are_no_dates_are_no_stamps(number: int) -> None:
    assert stamp_s(str(number)) is None
    assert stamps_s(np.array([number, number + 1.0])) is None
