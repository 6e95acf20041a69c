"""Recordings at the pace they were made, or any other."""

from __future__ import annotations

import time
from itertools import islice
from pathlib import Path
from threading import Timer

import numpy as np
import pytest

from tactile_graph import Frame
from tactile_graph.errors import DataError
from tactile_graph.steps.injected import Report
from tactile_graph_sources.replay import replay
from tactile_graph_sources.writers.write_npz import write_npz
from tactile_graph_sources.writers.write_store import StoreWriter

pytest.importorskip("zarr", reason="the 'zarr' extra is not installed")


@pytest.fixture(params=[".zarr", ".npz"])
def path(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    return recorded(tmp_path / f"a{request.param}", [0.0, 0.1, 0.2, 10.2, 10.3])


def recorded(target: Path, times: list[float | None]) -> Path:
    made = [
        Frame.of(np.full((2, 3), i), quantity="counts", index=i, time_s=t)
        for i, t in enumerate(times)
    ]
    if target.suffix == ".npz":
        write_npz(target, made)
        return target
    with StoreWriter(target) as store:
        for frame in made:
            store.write(frame)
    return target


def took(**settings: object) -> tuple[list[Frame], float]:
    start = time.monotonic()
    got = list(replay(report=Report(), **settings))  # type: ignore[arg-type]
    return got, time.monotonic() - start


def test_frames_come_at_their_time_divided_by_the_speed(path: Path) -> None:
    got, seconds = took(path=path, speed=50.0)
    assert seconds >= 10.3 / 50.0
    assert [int(f.image.values[0, 0]) for f in got] == [0, 1, 2, 3, 4]
    assert [f.time_s for f in got] == [0.0, 0.1, 0.2, 10.2, 10.3]


@pytest.mark.slow
def test_long_pauses_may_be_cut(path: Path) -> None:
    _, seconds = took(path=path, longest_pause_s=0.1)
    assert 0.4 <= seconds < 8.0


def test_a_pause_ends_once_no_frame_is_wanted(path: Path) -> None:
    report = Report()
    timer = Timer(0.3, setattr, (report, "wanted", False))
    timer.start()
    start = time.monotonic()
    assert len(list(replay(path=path, report=report))) == 3
    assert time.monotonic() - start < 8.0
    timer.join()


def test_without_a_speed_nothing_is_waited_for(path: Path) -> None:
    _, seconds = took(path=path, speed=None)
    assert seconds < 8.0


def test_a_rate_goes_before_the_recorded_times(path: Path) -> None:
    _, seconds = took(path=path, rate_hz=20.0)
    assert 0.2 <= seconds < 8.0


def test_looping_numbers_on_and_marks_the_seam(path: Path) -> None:
    source = replay(path=path, speed=None, loop=True, report=Report())
    got = list(islice(source, 12))
    assert [f.index for f in got] == list(range(12))
    assert [f.index for f in got if f.gap] == [5, 10]


def test_a_recording_without_times_asks_for_a_rate(tmp_path: Path) -> None:
    path = recorded(tmp_path / "a.zarr", [None, None])
    with pytest.raises(DataError, match="frame 0 has no time; give rate_hz, or speed: null"):
        list(replay(path=path, report=Report()))
    assert len(list(replay(path=path, rate_hz=1000.0, report=Report()))) == 2


def test_a_clock_that_was_set_back_does_not_stop_the_play(tmp_path: Path) -> None:
    path = recorded(tmp_path / "a.zarr", [100.0, 0.0, 0.1])
    _, seconds = took(path=path)
    assert 0.1 <= seconds < 8.0
