"""What is left of a variant that ran beside."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("starlette", reason="the live extra is not installed")

from tactile_graph import Frame
from tactile_graph_live.bench.wire import Compared
from tactile_graph_live.server.comparison import words_of, write_comparison


def compared(*indices: int, **more: Any) -> Compared:
    summary = {"variant": "circle-3", "frames": 200, "passed": 40, "same_outcomes": 199,
               "median_us": 99.6, "beside_median_us": 140.2, "trouble": "",
               "differences": {"circle.x_cm": {"mean": float("nan"), "most": 2.0}}}  # fmt: skip
    frames = tuple(
        Frame.of(np.full((4, 4), float(i)), (1.0, 1.0), (0.0, 0.0), "volt", index=i)
        for i in indices
    )
    return Compared({**summary, **more}, frames, tuple({"frame": i} for i in indices))


def test_agreement_and_times_are_told_in_a_line() -> None:
    assert words_of(compared()) == (
        "circle-3 beside: 199 of 200 frames with the same outcomes, median 140 µs against 100 µs"
    )


@pytest.mark.parametrize(
    ("more", "told"),
    [({"trouble": "it crashed"}, "it crashed"), ({"frames": 0}, "no frame was answered")],
)
def test_without_figures_the_reason_is_told(more: dict[str, Any], told: str) -> None:
    assert words_of(compared(**more)) == f"circle-3 beside: {told}"


def test_figures_and_frames_are_written_beside_each_other(tmp_path: Path) -> None:
    pytest.importorskip("zarr", reason="the extra `zarr` is not there")
    figures, store = write_comparison(tmp_path, compared(9, 4))
    written = json.loads(figures.read_text(), parse_constant=pytest.fail)
    assert written["same_outcomes"] == 199
    assert written["differences"]["circle.x_cm"] == {"mean": None, "most": 2.0}
    assert [k["frame"] for k in written["kept"]] == [9, 4]
    assert figures.stem == store.stem
    assert store.is_dir()


def test_without_frames_that_differ_there_is_no_store(tmp_path: Path) -> None:
    (figures,) = write_comparison(tmp_path, compared())
    assert list(tmp_path.iterdir()) == [figures]


def test_a_hostile_name_stays_within_the_folder(tmp_path: Path) -> None:
    (figures,) = write_comparison(tmp_path, compared(variant="../../etc/<x>"))
    assert figures.parent == tmp_path
