"""Recordings read in place: any range of frames, as the source itself would have given them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tactile_graph import Frame
from tactile_graph.engine.blocks.gathering import flat
from tactile_graph.steps import Report
from tactile_graph.steps.ranges import Irregular, Ranges
from tactile_graph.wires.frame_stack import FrameStack
from tactile_graph_sources.readers.sequence.in_ranges import ranges_of_recordings
from tactile_graph_sources.recording import recording, recording_stacked
from tactile_graph_sources.writers.write_store import StoreWriter

pytestmark = pytest.mark.slow
LARGE = 3000
"""Frames of 8 x 8 cells that are mapped, not read."""


def store(path: Path, n: int, garbage: tuple[int, ...] = (), pause: int | None = None) -> Path:
    pytest.importorskip("zarr", reason="the 'zarr' extra is not installed")
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


# -- arrays --------------------------------------------------------------------------------------


def pressed(n: int) -> Any:
    rng = np.random.default_rng(n)
    values = 0.001 * rng.random((n, 8, 8))
    values[:, 2:5, 2:5] += 1.0
    return values


def archive(path: Path, n: int, **more: Any) -> Path:
    np.savez(path, **{"values": pressed(n), "pitch_cm": (1.0, 2.0), "time_s": 0.1 * np.arange(n)}
             | more)  # fmt: skip
    return path


def array(path: Path, values: Any) -> Path:
    np.save(path, values)
    return path


VALID = np.arange(40 * 64).reshape(40, 8, 8) % 97 > 0


@pytest.mark.parametrize("settings", [{}, {"skip": 7}, {"flip": "both"}], ids=str)
@pytest.mark.parametrize("make", [
    lambda p: archive(p / "a.npz", 40),
    lambda p: archive(p / "a.npz", LARGE),
    lambda p: archive(p / "a.npz", 40, valid=VALID, label=np.array(["left"] * 40),
                      gap=np.arange(40) == 5, doubtful=np.arange(40) % 9 == 0),
    lambda p: archive(p / "a.npz", 40, values=np.where(VALID, pressed(40), np.nan)),
    lambda p: [archive(p / "a.npz", 23), archive(p / "b.npz", 31)],
    lambda p: array(p / "a.npy", pressed(40)),
    lambda p: array(p / "a.npy", pressed(LARGE).astype(np.float32)),
    lambda p: array(p / "a.npy", (1000.0 * pressed(40)).astype(np.int16)),
    lambda p: array(p / "a.npy", np.where(VALID, pressed(40), np.nan)),
    lambda p: [array(p / "a.npy", pressed(40)), archive(p / "b.npz", 31)],
], ids=["npz", "large npz", "npz that says more", "npz with gaps", "two npz", "npy", "large npy",
        "npy of integers", "npy with gaps", "npy and npz"])  # fmt: skip
def test_any_range_of_an_array_is_what_the_source_gives(
    tmp_path: Path, make: Any, settings: dict[str, Any]
) -> None:
    path = make(tmp_path)
    report = Report()
    whole = [told(f) for f in recording(path=path, report=report, **settings)]
    found = ranges(path, **settings)
    assert found.n_frames == len(whole)
    assert found.read_in_stacks is not None
    assert found.tell is not None
    few = len(whole) < LARGE // 2
    for low in range(0, len(whole), 9) if few else (0, 511, 2900):
        for high in (low + 1, low + 13, len(whole)):
            high = min(high, len(whole))
            assert [told(f) for f in found.read(low, high)] == whole[low:high]
            assert [told(f) for f in flat(found.read_in_stacks(low, high))] == whole[low:high]
    said = Report()
    found.tell(said)
    assert said.counts == {k: n for k, n in report.counts.items() if k != "frames"}
    assert said.digests == report.digests


def test_a_foreign_archive_is_read_as_the_source_reads_it(tmp_path: Path) -> None:
    path = tmp_path / "a.npz"
    np.savez(path, left=pressed(LARGE), right=pressed(50), time_ms=np.arange(LARGE))
    assert ranges_of_recordings(path) is None  # which of them nobody says
    whole = [told(f) for f in recording(path=path, report=Report(), sensor="left")]
    assert len(whole) == LARGE
    found = ranges(path, sensor="left")
    assert [told(f) for f in found.read(700, 800)] == whole[700:800]


def test_large_arrays_come_in_stacks(tmp_path: Path) -> None:
    found = ranges(array(tmp_path / "a.npy", pressed(LARGE)))
    assert found.read_in_stacks is not None
    read = [*found.read_in_stacks(700, 2000)]
    assert all(isinstance(some, FrameStack) for some in read)


@pytest.mark.parametrize("make", [
    lambda p: np.savez_compressed(p, values=pressed(40)),
    lambda p: np.savez(p, a_1=pressed(1)[0], a_2=pressed(1)[0]),
    lambda p: archive(p, 40, time_s=np.where(np.arange(40) < 9, np.nan, 0.1 * np.arange(40))),
    lambda p: archive(p, 2, truth=np.array("[null, null]")),
    lambda p: np.savez(p, values=np.asfortranarray(pressed(40))),
    lambda p: archive(p, 40, pitch_cm=(0.0, 1.0)),
    lambda p: p.write_bytes(b"PK\x03\x04 cut off"),
], ids=["packed", "numbered", "times unknown", "a truth", "columns first", "no pitch",
        "damaged"])  # fmt: skip
def test_archives_that_are_left_to_who_reads_from_the_start(tmp_path: Path, make: Any) -> None:
    make(tmp_path / "a.npz")
    assert ranges_of_recordings(tmp_path / "a.npz") is None


def test_a_damaged_byte_is_found_by_who_looks_through_it_for_all(tmp_path: Path) -> None:
    path = archive(tmp_path / "a.npz", LARGE)
    raw = bytearray(path.read_bytes())
    raw[len(raw) // 2] ^= 1
    path.write_bytes(raw)
    found = ranges(path)
    assert found.tell is not None
    with pytest.raises(Irregular, match="CRC"):
        found.tell(Report())


@pytest.mark.parametrize("number", [-999.0, 1e20, -2000.0])
def test_what_may_stand_for_no_reading_makes_it_irregular(tmp_path: Path, number: float) -> None:
    values = pressed(60)
    values[30, 0, 0] = number
    found = ranges(array(tmp_path / "a.npy", values))
    with pytest.raises(Irregular, match="no reading"):
        list(found.read(20, 28))  # those around it are looked at, too


def test_garbage_in_an_array_makes_it_irregular(tmp_path: Path) -> None:
    values = pressed(200)
    values[150] = 5.0 * np.random.default_rng(0).random((8, 8))
    found = ranges(array(tmp_path / "a.npy", values))
    assert len(list(found.read(0, 100))) == 100
    with pytest.raises(Irregular, match="garbage"):
        list(found.read(145, 155))
