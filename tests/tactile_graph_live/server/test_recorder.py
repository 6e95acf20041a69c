"""Frames into a store, each with the label of its moment."""

from __future__ import annotations

from datetime import datetime
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("starlette", reason="the live extra is not installed")

from tactile_graph import Frame
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
    read = list(source.frames())
    assert [f.label for f in read] == ["cup"] * 3 + ["ball"] * 2
    assert [f.image.values[0, 0] for f in read] == [0, 1, 2, 5, 6]
    assert failures == []


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
