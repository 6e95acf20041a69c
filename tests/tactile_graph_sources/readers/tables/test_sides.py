"""Sections of a table that are of the left and of the right of two sensors."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from helpers_recordings import frames_of, write
from tactile_graph.errors import DataError
from tactile_graph_sources.readers import head
from tactile_graph_sources.readers.choice import SeveralSensorsError

FEET = np.random.default_rng(0).uniform(50, 100, (2, 4, 6, 4)).round(1)
NAMES = "Left", "Right"


def matrix(foot: int, k: int) -> str:
    return "".join("\t".join(f"{v:.1f}" for v in row) + "\n" for row in FEET[foot, k]) + "\n"


def in_turn(title: str) -> str:
    return "Unit: kPa\n" + "".join(
        title.format(side=NAMES[foot], k=k) + matrix(foot, k) for k in range(4) for foot in (0, 1)
    )


def in_sections(title: str, frame: str = "") -> str:
    return "Unit: kPa\n" + "".join(
        title.format(side=NAMES[foot])
        + "".join(frame.format(k) + matrix(foot, k) for k in range(4))
        for foot in (0, 1)
    )


TEXTS = {
    "frames": in_turn("Frame {k} {side}\n"),
    "timed frames": in_turn("Frame {k} ({side}) t = 0.{k} s\n"),
    "insole / frame": in_turn("{side} insole / Frame {k}\n"),
    "insole, frame": in_turn("{side} insole\nFrame {k}\n"),
    "brackets": in_sections("[{side}]\n"),
    "comments": in_sections("# {side} foot\n", "Frame {}\n"),
    "sides": in_sections("Side: {side}\n", "Frame {}\n"),
}


@pytest.mark.parametrize("text", TEXTS.values(), ids=TEXTS)
def test_sections_are_read_by_the_name_of_their_side(text: str, tmp_path: Path) -> None:
    path = write(tmp_path, text)
    with pytest.raises(SeveralSensorsError, match="say: Left, Right; name one with sensor"):
        frames_of(path)
    for foot, sensor in ((0, "left"), (1, "Right foot")):
        frames, report = frames_of(path, sensor=sensor)
        assert np.array_equal([f.image.values for f in frames], FEET[foot])
        assert not report.troubles
    with pytest.raises(DataError, match=r"no sensor 'heel'; .*Left, Right"):
        frames_of(path, sensor="heel")


def test_lines_of_a_frame_each_stand_in_sections_too(tmp_path: Path) -> None:
    header = "time_s," + ",".join(f"r{i}c{j}" for i in range(6) for j in range(4)) + "\n"
    lines = [
        "".join(f"0.{k}," + ",".join(f"{v:.1f}" for v in m.ravel()) + "\n" for k, m in enumerate(f))
        for f in FEET
    ]
    path = write(tmp_path, f"Left foot\n{header}{lines[0]}\nRight foot\n{header}{lines[1]}")
    with pytest.raises(SeveralSensorsError):
        frames_of(path)
    for foot, sensor in enumerate(NAMES):
        frames, _ = frames_of(path, sensor=sensor)
        assert np.array_equal([f.image.values for f in frames], FEET[foot])


@pytest.mark.parametrize("text", [TEXTS["sides"], TEXTS["brackets"]], ids=["sides", "brackets"])
def test_a_section_far_behind_is_not_dropped(
    text: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(head, "SAMPLE", text.index("Right") - 20)
    path = write(tmp_path, text)
    with pytest.raises(SeveralSensorsError, match="Left, Right; name one with sensor"):
        frames_of(path)
    for foot, sensor in enumerate(NAMES):
        frames, _ = frames_of(path, sensor=sensor)
        assert np.array_equal([f.image.values for f in frames], FEET[foot])


@pytest.mark.parametrize(
    "text",
    [
        in_sections("{side}: sensor 4\n").replace("Right: sensor 4\n", ""),
        "Left: 4\nRight: 5\n" + in_sections(""),
        in_sections("") + "Right foot\n",
        in_sections("# turned {side}\n"),
    ],
    ids=["one", "no rows between", "no rows behind", "remarks"],
)
def test_words_that_are_no_titles_of_sections_part_nothing(text: str, tmp_path: Path) -> None:
    frames, _ = frames_of(write(tmp_path, text))
    assert len(frames) in (7, 8)
