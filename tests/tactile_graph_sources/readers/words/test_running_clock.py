"""Times that texts say: offsets, midnight, full hours, leap seconds, milliseconds, durations."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from helpers_recordings import frames_of, npz_bytes, write
from tactile_graph.errors import DataError
from tactile_graph_sources.readers.words import moments
from tactile_graph_sources.readers.words.moments import clock_s, colon_unit_s, zone_remedy
from tactile_graph_sources.readers.words.running_clock import RunningClock

SPRING = [
    "2024-03-31T01:59:58+01:00", "2024-03-31T01:59:59+01:00",
    "2024-03-31T03:00:00+02:00", "2024-03-31T03:00:01+02:00",
]  # fmt: skip
FRAMES = np.arange(4 * 9.0).reshape(4, 3, 3)
WITHOUT = "times without an offset from UTC taken to have that of those before"


def run(texts: list[str], given: str = "") -> tuple[list[float], set[str]]:
    """Return the seconds from the first time on, and what is told."""
    told: list[str] = []
    clock = RunningClock("a.csv", told.append, given, 0.0 if given else colon_unit_s(texts))
    at = [clock.read(text) for text in texts]
    assert None not in at, texts
    return [round(a - at[0], 6) for a in at], {*told}  # type: ignore[operator]


def table(times: list[str]) -> str:
    head = "time," + ",".join(f"r{k // 3}c{k % 3}" for k in range(9))
    rows = (f"{t}," + ",".join(map(str, f.ravel())) for t, f in zip(times, FRAMES, strict=True))
    return "\n".join([head, *rows]) + "\n"


def contents(times: list[str]) -> list[str | bytes]:
    entries = [{"time": t, "values": f.tolist()} for t, f in zip(times, FRAMES, strict=True)]
    return [table(times), json.dumps(entries), npz_bytes(frames=FRAMES, time=np.array(times))]


@pytest.mark.parametrize("kind", range(3), ids=["csv", "json", "npz"])
def test_offsets_from_utc_count_in_every_format(kind: int, tmp_path: Path) -> None:
    frames, report = frames_of(write(tmp_path, contents(SPRING)[kind]))
    assert [f.time_s for f in frames] == [0.0, 1.0, 2.0, 3.0]
    assert not [what for what in report.counts if "time" in what]


def test_offsets_count_in_a_told_format(tmp_path: Path) -> None:
    frames, _ = frames_of(write(tmp_path, table(SPRING)), time_format="%Y-%m-%dT%H:%M:%S%z")
    assert [f.time_s for f in frames] == [0.0, 1.0, 2.0, 3.0]


@pytest.mark.parametrize("kind", range(3), ids=["csv", "json", "npz"])
def test_times_with_and_without_an_offset_are_told(kind: int, tmp_path: Path) -> None:
    times = [SPRING[0].removesuffix("+01:00"), *SPRING[1:3], SPRING[3].removesuffix("+02:00")]
    frames, report = frames_of(write(tmp_path, contents(times)[kind]))
    assert [f.time_s for f in frames] == [0.0, 1.0, 2.0, 3.0]
    assert report.counts[f"recordings with {WITHOUT}"] == 1


@pytest.mark.parametrize(
    "texts",
    [
        ["2024-06-01T12:00:00+02:00", "2024-06-01T10:00:01Z", "2024-06-01 10:00:02 UTC"],
        ["2024-06-01 12:00:00 GMT", "2024-06-01 14:00:01 UTC+2", "2024-06-01 13:00:02 GMT+01:00"],
        ["2024-06-01 12:00:00+02", "2024-06-01 13:00:01 +0300", "2024-06-01 06:30:02 -0330"],
        ["23:59:59+02:00", "00:00:00+02:00", "23:00:01+01:00"],
        ["23:59:59", "00:00:00", "00:00:01"],
        ["59:59.0", "00:00.0", "00:01.0"],
        ["59:59.0", "60:00.0", "60:01.0"],
        ["2016-12-31T23:59:59Z", "2016-12-31T23:59:60Z", "2017-01-01T00:00:00Z"],
        ["23:59:59.5", "23:59:60.5", "00:00:00.5"],
        ["PT0S", "PT1S", "PT2.0S"],
        ["P1DT1M", "P1DT0H1M1S", "P1DT62S"],
    ],
)
def test_what_passes_is_a_second_each(texts: list[str]) -> None:
    assert run(texts) == ([0.0, 1.0, 2.0], set())


@pytest.mark.parametrize(
    ("texts", "expected"),
    [
        (["35:00.0", "00:00.0"], [0.0, -2100.0]),  # begun anew: no full hour
        (
            ["2024-06-02T12:00:00", "2024-06-01T12:00:00"],
            [0.0, -86400.0],
        ),  # dated
        (["12:00:59.9", "12:00:60", "12:01:00.1"], [0.0, 0.1, 0.2]),  # rounded, no leap second
    ],
)
def test_times_are_not_made_to_go_on_where_nothing_says_so(
    texts: list[str], expected: list[float]
) -> None:
    assert run(texts)[0] == pytest.approx(expected)


@pytest.mark.parametrize(
    ("ends", "expected"),
    [
        (["00:5", "00:505", "01:5"], [0.0, 0.5, 1.0]),
        (["00:900", "00:950", "01:0", "01:50"], [0.0, 0.05, 0.1, 0.15]),
        (["00:900", "00:950", "01:000", "01:050"], [0.0, 0.05, 0.1, 0.15]),
        (["00:999500", "01:0", "01:500"], [0.0, 0.0005, 0.001]),
        (["00.0", "00.50", "01.000"], [0.0, 0.5, 1.0]),
    ],
)
def test_behind_a_colon_milliseconds_are_known_by_their_differing_digits(
    ends: list[str], expected: list[float]
) -> None:
    assert run([f"12:00:{end}" for end in ends]) == (expected, set())


def test_times_without_a_last_colon_are_not_read_for_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(moments, "moment_of", None)
    assert colon_unit_s(["12:00:01.5", "12:00:01", "", *(t.partition("+")[0] for t in SPRING)]) == 0


def test_few_digits_behind_a_colon_are_told_and_refused_where_more_come() -> None:
    doubt = "times such as '12:00:00:5' taken to end in decimals of a second"
    assert run(["12:00:00:5", "12:00:00:6"]) == ([0.0, 0.1], {doubt})
    clock = RunningClock("a.csv", lambda _: None)
    clock.read("12:00:00:5")
    with pytest.raises(DataError, match="3 digits behind the last ':', times before 1: write all"):
        clock.read("12:00:00:505")


def test_a_table_in_milliseconds_without_their_zeros(tmp_path: Path) -> None:
    times = ["12:00:00:5", "12:00:00:505", "12:00:01:5", "12:00:01:505"]
    frames, _ = frames_of(write(tmp_path, table(times)))
    assert [f.time_s for f in frames] == [0.0, 0.5, 1.0, 1.5]


def test_words_for_a_zone_are_refused_with_the_remedy(tmp_path: Path) -> None:
    texts = [f"2024-06-01 12:00:0{k} CEST" for k in range(4)]
    assert clock_s(texts[0]) is None
    with pytest.raises(DataError, match=r"zone 'CEST': leave it out, or write the offset instead"):
        frames_of(write(tmp_path, table(texts)))
    for content in contents(texts)[1:]:
        _, report = frames_of(write(tmp_path, content))
        assert any("write the offset instead, such as +02:00" in what for what in report.counts)
    assert zone_remedy("noon CEST") == ""


def test_an_offset_that_no_zone_has_is_no_time() -> None:
    assert clock_s("12:00:00+23:00") is None
