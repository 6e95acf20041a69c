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
    "frame above": in_turn("Frame {k}\n{side}\n"),
    "filled frame above": in_turn("Frame {k}\t\t\t\n{side}\t\t\t\n"),
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
    with pytest.raises(DataError, match="no sensor 'right toe'"):
        frames_of(path, sensor="right toe")


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


@pytest.mark.parametrize(
    "title", ["{} foot pressure (kPa)", "{} insole size 42", "# {}", "{} heel"]
)
def test_titles_that_say_more_are_those_of_sections_where_a_sensor_is_told(
    title: str, tmp_path: Path
) -> None:
    path = write(tmp_path, in_sections(title.replace("{}", "{side}") + "\n"))
    frames, report = frames_of(path)
    assert len(frames) in (7, 8)
    said = title.format("Left")
    remedy = "(give sensor=Left if they are titles of sections)"
    assert f"recordings with lines such as {said!r} taken for remarks {remedy}" in report.counts
    for foot, sensor in enumerate(NAMES):
        frames, _ = frames_of(path, sensor=sensor)
        assert np.array_equal([f.image.values for f in frames], FEET[foot])
    with pytest.raises(DataError, match=r"no sensor 'left toe'; .*Left, Right"):
        frames_of(path, sensor="left toe")


def test_rows_that_begin_with_a_side_are_no_titles(tmp_path: Path) -> None:
    lines = [
        f"[{NAMES[foot]}]\n"
        + "".join(
            "".join(f"{NAMES[foot]}\t{row}\n" for row in matrix(foot, k).splitlines()[:6]) + "\n"
            for k in range(4)
        )
        for foot in (0, 1)
    ]
    for foot, sensor in enumerate(NAMES):
        frames, _ = frames_of(write(tmp_path, "".join(lines)), sensor=sensor)
        assert np.array_equal([f.image.values for f in frames], FEET[foot])


def test_marks_in_a_series_are_no_sections(tmp_path: Path) -> None:
    marks = {1: "# left\n", 3: "# right\n"}
    lines = (
        marks.get(k, "") + f"0.{k}," + ",".join(f"{v:.1f}" for v in m.ravel()) + "\n"
        for k, m in enumerate(FEET[0])
    )
    frames, _ = frames_of(write(tmp_path, "".join(lines)), rows=6, columns=4)
    assert np.array_equal([f.image.values for f in frames], FEET[0])


@pytest.mark.parametrize("lead", ["t = 0.{k} s\n", "Frame {k}, t = 0.{k} s\n\n", "0.{k}\n"])
@pytest.mark.parametrize("both", [True, False], ids=["of each", "of both"])
def test_a_time_before_a_title_is_that_of_the_matrix_behind_it(
    both: bool, lead: str, tmp_path: Path
) -> None:
    text = "".join(
        lead.format(k=k) * (both or not foot) + f"{NAMES[foot]}\n" + matrix(foot, k)
        for k in range(4)
        for foot in (0, 1)
    )
    path = write(tmp_path, text)
    for foot, sensor in enumerate(NAMES):
        frames, report = frames_of(path, sensor=sensor)
        assert np.array_equal([f.image.values for f in frames], FEET[foot])
        assert np.allclose([f.time_s for f in frames], [0.0, 0.1, 0.2, 0.3])
        assert not report.troubles


def test_frames_of_one_number_in_sections_of_both_sides_stay_with_theirs(tmp_path: Path) -> None:
    text = "Frame 9\n" + in_sections("{side}\n", "Frame {}\n")
    frames, report = frames_of(write(tmp_path, text), sensor="right")
    assert np.array_equal([f.image.values for f in frames], FEET[1])
    assert not report.troubles


def test_a_hand_and_a_foot_of_one_side_are_two_sensors(tmp_path: Path) -> None:
    text = in_sections("{side} foot\n").replace("Right foot", "Left hand")
    path = write(tmp_path, text)
    with pytest.raises(SeveralSensorsError, match="Left foot, Left hand; name one"):
        frames_of(path)
    with pytest.raises(DataError, match="sensor=left may be any of"):
        frames_of(path, sensor="left")
    for foot, sensor in enumerate(("left insole", "left hand")):
        frames, _ = frames_of(path, sensor=sensor)
        assert np.array_equal([f.image.values for f in frames], FEET[foot])


@pytest.mark.parametrize(
    ("text", "sensor"),
    [
        (in_sections("Sensor {side}\n").replace("Left", "A").replace("Right", "B"), "A"),
        (in_sections("[{side}]\n").replace("Left", "Right"), "left"),
        (in_sections("[{side} foot]\n").replace("Left", "Right"), "right hand"),
        (in_sections(""), "left"),
        (in_sections("# turned left\n"), "right"),
    ],
    ids=["letters", "the other side", "another thing", "none", "remarks"],
)
def test_a_sensor_that_a_table_does_not_tell_apart_is_refused(
    text: str, sensor: str, tmp_path: Path
) -> None:
    with pytest.raises(DataError, match=f"no sensor '{sensor}'"):
        frames_of(write(tmp_path, text), sensor=sensor)


@pytest.mark.parametrize(
    "text",
    [
        "Sensor: palm 2\n" + in_sections("", "Frame {}\n").replace("Unit: kPa\n", ""),
        in_sections("[{side}]\n").replace("Left", "Right").replace("Right", "Palm"),
        "time," + ",".join(f"palm_{k}" for k in range(16)) + "\n"
        + "".join(f"0.{k}" + f",{k}.5" * 16 + "\n" for k in range(4)),
        "time,sensor," + ",".join(f"r{k // 4}c{k % 4}" for k in range(16)) + "\n"
        + "".join(f"0.{k},palm" + f",{k}.5" * 16 + "\n" for k in range(4)),
    ],
    ids=["words", "section", "columns", "lines"],
)  # fmt: skip
def test_a_sensor_that_is_the_only_one_may_be_named(text: str, tmp_path: Path) -> None:
    frames, _ = frames_of(write(tmp_path, text), sensor="palm")
    assert len(frames) in (4, 7, 8)
