"""Frames into a store, each with the label of its moment."""

from __future__ import annotations

import errno
from dataclasses import replace
from datetime import datetime
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("starlette", reason="the live extra is not installed")

from tactile_graph import Frame
from tactile_graph.steps import Report
from tactile_graph_live.server import recorder as recorders
from tactile_graph_live.server.recorder import Recorder, free_name

NOON = datetime(2026, 5, 4, 12, 0, 1)


def frames(first: int, n: int) -> list[Frame]:
    return [
        Frame.of(
            np.full((4, 4), float(i)), (1.0, 1.0), (0.0, 0.0), "counts", index=i, time_s=i / 10
        )
        for i in range(first, first + n)
    ]


@pytest.mark.parametrize(
    ("name", "told"),
    [("locate", "locate"), ("../x y", "x-y"), ("", "pad"), ("ä" * 9, "pad"), ("a" * 99, "a" * 60)],
)
def test_a_store_is_named_by_time_and_pipeline_within_the_folder(
    tmp_path: Path, name: str, told: str
) -> None:
    assert free_name(tmp_path, name, NOON) == tmp_path / f"20260504-120001-{told}.zarr"


def test_a_name_that_is_taken_gets_a_number(tmp_path: Path) -> None:
    free_name(tmp_path, "a", NOON).mkdir()
    (tmp_path / "20260504-120001-a-2.zarr").symlink_to(tmp_path / "nothing")
    assert free_name(tmp_path, "a", NOON).name == "20260504-120001-a-3.zarr"


def test_every_frame_is_kept_with_the_label_of_its_moment(tmp_path: Path) -> None:
    pytest.importorskip("zarr", reason="the extra `zarr` is not there")
    from tactile_graph import load

    failures: list[str] = []
    recorder = Recorder(tmp_path, "mine", "cup", {"pipeline": "mine"}, failures.append)
    recorder.take(frames(0, 3), 0)
    recorder.label = "ball"
    recorder.take(frames(5, 2), 2)
    assert recorder.close() == 5
    assert (recorder.state.lost, recorder.state.label) == (2, "ball")
    source = load("circle-1").with_source("recording", path=str(recorder.path), quantity="counts")
    read = list(source.frames(report=Report()))
    assert [f.label for f in read] == ["cup"] * 3 + ["ball"] * 2
    assert [f.image.values[0, 0] for f in read] == [0, 1, 2, 5, 6]
    assert failures == []


STATE = """
pipeline: tared
nodes: {tared: {step: tare, in: frame, with: {n_frames: 2}}}
outputs: [tared]
"""


@pytest.mark.parametrize("older", [False, True])
def test_state_goes_on_where_the_label_of_the_moment_changes(tmp_path: Path, older: bool) -> None:
    pytest.importorskip("zarr", reason="the extra `zarr` is not there")
    from tactile_graph import loads
    from tactile_graph_sources.writers.write_npz import write_npz
    from tactile_graph_sources.writers.write_store import StoreWriter

    about = {"port": "source simulate", "pipeline": "tared"}
    recorder = Recorder(tmp_path, "tared", "", about, lambda _: None)
    recorder.take(frames(0, 3), 0)
    recorder.label = "cup"
    recorder.take(frames(3, 2), 0)
    recorder.close()
    path = recorder.path
    if older:  # than notes on whose state it is
        path = tmp_path / "older.zarr"
        with StoreWriter(path, about=about) as store:
            for k, frame in enumerate(frames(0, 5)):
                store.write(replace(frame, label="cup" if k > 2 else ""))
    source = loads(STATE).with_source("recording", path=str(path))
    assert [r["tared"].peak for r in source.stream() if "tared" in r] == [0.5, 1.5, 2.5, 3.5]
    write_npz(tmp_path / "same.npz", source.frames())
    again = source.with_source("recording", path=[str(path), str(tmp_path / "same.npz")])
    rows = [(r.frame.label, r["tared"].peak) for r in again.stream() if "tared" in r]
    assert [peak for _, peak in rows] == [0.5, 1.5, 2.5, 3.5] * 2
    assert [label for label, _ in rows[-2:]] == ["same.npz cup"] * 2


def test_a_label_of_the_moment_leaves_each_sensor_its_state(tmp_path: Path) -> None:
    pytest.importorskip("zarr", reason="the extra `zarr` is not there")
    from tactile_graph import load

    recorder = Recorder(tmp_path, "two", "", {}, lambda _: None)
    both = [replace(f, label=name) for f in frames(0, 2) for name in ("left", "right")]
    recorder.take(both[:2], 0)
    recorder.label = "cup"
    recorder.take(both[2:], 0)
    recorder.close()
    read = list(load("circle-1").with_source("recording", path=str(recorder.path)).frames())
    assert [f.label for f in read] == ["left", "right", "cup", "cup"]
    assert [f.state_of for f in read] == ["left", "right"] * 2


def test_the_frame_after_a_break_of_unknown_length_follows_a_gap(tmp_path: Path) -> None:
    pytest.importorskip("zarr", reason="the extra `zarr` is not there")
    from tactile_graph import load

    recorder = Recorder(tmp_path, "mine", "", {}, [].append)
    recorder.take(frames(0, 2), 0)
    recorder.broken_off()
    recorder.take(frames(0, 2), 0)
    assert recorder.close() == 4
    assert (recorder.n_breaks, recorder.state.lost) == (1, 0)
    source = load("circle-1").with_source("recording", path=str(recorder.path), quantity="counts")
    assert [f.gap for f in source.frames(report=Report())] == [False, False, True, False]


def test_what_goes_wrong_is_told_and_closing_still_ends(tmp_path: Path) -> None:
    pytest.importorskip("zarr", reason="the extra `zarr` is not there")
    failures: list[str] = []
    recorder = Recorder(tmp_path, "mine", "", {}, failures.append)
    recorder.take(frames(0, 1), 0)
    wider = Frame.of(np.zeros((5, 5)), (1.0, 1.0), (0.0, 0.0), "counts", index=1)
    recorder.take([wider], 0)
    recorder.close()
    assert len(failures) == 1
    assert "5" in failures[0]


def test_a_full_disc_is_told_once_and_what_was_written_counts(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("zarr", reason="the extra `zarr` is not there")
    from tactile_graph_sources.writers.write_store import StoreWriter

    put = StoreWriter._put

    def full(self: StoreWriter, some: list[Frame]) -> None:
        if self.n_written:
            raise OSError(errno.ENOSPC, "No space left on device")
        put(self, some)

    monkeypatch.setattr(StoreWriter, "_put", full)
    failures: list[str] = []
    recorder = Recorder(tmp_path, "mine", "", {}, failures.append)
    recorder.take(frames(0, 600), 0)
    assert recorder.close() == 256
    assert len(failures) == 1
    assert "No space left" in failures[0]


def test_what_the_disc_does_not_keep_up_with_is_counted_and_leaves_a_gap(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("zarr", reason="the extra `zarr` is not there")
    import threading

    from tactile_graph import load
    from tactile_graph_sources.writers.write_store import StoreWriter

    goes_on, write = threading.Event(), StoreWriter.write

    def slow(self: StoreWriter, frame: Frame) -> None:
        goes_on.wait(30)
        write(self, frame)

    monkeypatch.setattr(StoreWriter, "write", slow)
    monkeypatch.setattr(recorders, "MOST_BYTES", 5 * 4 * 4 * 8)
    failures: list[str] = []
    recorder = Recorder(tmp_path, "mine", "", {}, failures.append)
    recorder.take(frames(0, 3), 0)
    recorder.take(frames(3, 3), 0)  # with these there would be six
    recorder.take(frames(6, 2), 0)
    assert recorder.state.lost == 3
    goes_on.set()
    assert recorder.close() == 5
    source = load("circle-1").with_source("recording", path=str(recorder.path), quantity="counts")
    read = list(source.frames())
    assert [f.image.values[0, 0] for f in read] == [0, 1, 2, 6, 7]
    assert [f.gap for f in read] == [False, False, False, True, False]
