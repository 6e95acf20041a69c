"""Tables that are read back."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tactile_graph import Frame
from tactile_graph.errors import DataError
from tactile_graph.steps.injected import Report
from tactile_graph_sources.recording import recording
from tactile_graph_sources.writers.write_csv import write_csv


@pytest.mark.parametrize("timed", [True, False])
def test_a_table_is_read_back(tmp_path: Path, timed: bool) -> None:
    rng = np.random.default_rng(0)
    values = rng.normal(size=(6, 3, 5))
    values[2, 1, 1] = np.nan
    made = [
        Frame.of(v, quantity="volt", index=i, time_s=0.1 * i if timed else None)
        for i, v in enumerate(values)
    ]
    path = tmp_path / "a.csv"
    assert write_csv(path, made) == 6
    read = list(recording(path=path, rows=3, columns=5, quantity="volt", report=Report()))
    assert [f.time_s for f in read] == [f.time_s for f in made]
    for a, b in zip(made, read, strict=True):
        np.testing.assert_array_equal(a.image.filled(np.nan), b.image.filled(np.nan))
    assert [p.name for p in tmp_path.iterdir()] == ["a.csv"]


MADE = [
    Frame.of(np.ones((3, 5)), pitch_cm=(0.5, 0.25), origin_cm=(-0.15, 1e-9), quantity="volt")
] * 2


def test_a_table_says_itself_what_shape_place_and_quantity_it_has(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    write_csv(path, MADE)
    report = Report()
    read = next(recording(path=path, report=report)).image
    assert (read.shape, read.pitch_cm, read.quantity) == ((3, 5), (0.5, 0.25), "volt")
    assert read.origin_cm == (-0.15, 1e-9)
    assert "recordings whose pitch is assumed to be 1 cm" not in report.counts


def test_settings_go_before_the_comment_unless_they_contradict_it(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    write_csv(path, MADE)
    assert next(recording(path=path, pitch_cm=1.3, report=Report())).image.pitch_cm == (1.3, 1.3)
    with pytest.raises(DataError, match="its values are volt, the settings say gram"):
        next(recording(path=path, quantity="gram", report=Report()))
    with pytest.raises(DataError, match="say 3 x 5 cells, the settings 5 x 3"):
        next(recording(path=path, rows=5, columns=3, report=Report()))


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("3 rows", "4 rows"),
        ("(0.5, 0.25)", "(0.5, 0)"),
        ("(0.5, 0.25)", "(inf, inf)"),
        ("(0.5, 0.25)", "(a, b)"),
        ("(-0.15,", "(nan,"),
        ("volt", "apples"),
    ],
)
def test_a_comment_that_cannot_be_true_is_only_a_comment(
    tmp_path: Path, before: str, after: str
) -> None:
    path = tmp_path / "a.csv"
    write_csv(path, MADE)
    text = path.read_text("utf-8")
    assert before in text
    path.write_text(text.replace(before, after, 1), "utf-8")
    read = next(recording(path=path, rows=3, columns=5, report=Report())).image
    assert (read.pitch_cm, read.origin_cm, read.quantity) == ((1.0, 1.0), (0.0, 0.0), "raw")


def test_nothing_is_left_behind_when_a_frame_does_not_fit(tmp_path: Path) -> None:
    made = [Frame.of(np.ones((2, 2)), time_s=0.0), Frame.of(np.ones((3, 2)), time_s=0.0)]
    with pytest.raises(DataError, match=r"frame 1 is of shape \(3, 2\), the first \(2, 2\)"):
        write_csv(tmp_path / "a.csv", made)
    with pytest.raises(DataError, match="frame 1 has no time, the first has one"):
        write_csv(tmp_path / "a.csv", [made[0], Frame.of(np.ones((2, 2)))])
    with pytest.raises(DataError, match="there is no frame to write"):
        write_csv(tmp_path / "a.csv", [])
    assert not list(tmp_path.iterdir())
