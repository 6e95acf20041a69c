"""Folders of numbered files, and files that are given in another order than theirs."""

from __future__ import annotations

import os
from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from helpers_recordings import blobs, flat_text, frames_of, stacked_text, write
from tactile_graph.errors import DataError
from tactile_graph.steps.injected import Report
from tactile_graph_sources.recording import recording, recording_stacked

VALUES = blobs(12, 5, 7)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return a folder of files of a frame each, from ``f0.csv`` to ``f11.csv``."""
    for k, matrix in enumerate(VALUES):
        write(tmp_path, stacked_text(matrix[None]), f"f{k}.csv")
    return tmp_path


def test_a_folder_of_frames_is_read_in_the_order_of_their_numbers(folder: Path) -> None:
    frames, report = frames_of(folder)
    np.testing.assert_array_equal([f.image.values for f in frames], VALUES)
    assert [f.index for f in frames] == list(range(12))
    assert {f.label for f in frames} == {""}
    assert not report.troubles
    assert len(report.digests) == 12
    assert report.counts["recordings whose pitch is assumed to be 1 cm"] == 1


def test_a_folder_of_recordings_is_read_one_after_the_other(tmp_path: Path) -> None:
    values = blobs(10, 8, 8)
    for k in range(2):
        lines = flat_text(values[5 * k : 5 * k + 5]).splitlines()
        text = "".join(f"{0.5 * (5 * k + j)},{line}\n" for j, line in enumerate(lines))
        write(tmp_path, text, f"2024-05-0{k + 1}.csv")
    frames, report = frames_of(tmp_path)
    np.testing.assert_array_equal([f.image.values for f in frames], values)
    assert [f.time_s for f in frames] == pytest.approx([0.5 * k for k in range(10)])
    assert not report.troubles


def test_a_file_of_a_folder_without_a_frame_is_told_and_the_next_follows_a_gap(
    folder: Path,
) -> None:
    damaged = stacked_text(VALUES[3:4]).splitlines()
    damaged[2] = damaged[2].replace(",", ",x", 1)
    write(folder, "\n".join(damaged), "f3.csv")
    frames, report = frames_of(folder)
    np.testing.assert_array_equal([f.image.values for f in frames], np.delete(VALUES, 3, axis=0))
    assert [k for k, f in enumerate(frames) if f.gap] == [3]
    assert [where for where, _ in report.troubles] == [f"{folder / 'f3.csv'}:1"]


@pytest.mark.parametrize("name", ["f0.csv", "f5.csv"])
def test_a_file_of_a_folder_that_may_not_be_read_is_named_before_the_work(
    folder: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    may = os.access
    monkeypatch.setattr(os, "access", lambda p, how: Path(p).name != name and may(p, how))
    with pytest.raises(DataError) as told:  # root may read any
        next(recording(path=folder, report=Report()))
    assert str(told.value) == f"{folder / name}: cannot be read: Permission denied"


@pytest.mark.parametrize("in_stacks", [False, True])
def test_frames_before_one_that_cannot_be_read_are_given(folder: Path, in_stacks: bool) -> None:
    write(folder, stacked_text(blobs(1, 6, 7)), "f9.csv")
    columns = dict.fromkeys(("frame_column", "time_column", "value_column", "cells"), "")
    unset = {**columns, "time_unit": "", "time_format": ""}
    read = recording_stacked if in_stacks else recording
    frames: Iterator[Any] = read(path=folder, report=Report(), **unset)  # type: ignore[operator]
    assert len([*islice(frames, 9)]) == 9
    with pytest.raises(DataError, match=r"f9\.csv: has frames of 6 x 7"):
        next(frames)


def test_files_of_another_size_in_a_folder_are_refused(folder: Path) -> None:
    write(folder, stacked_text(blobs(1, 6, 7)), "f3.csv")
    with pytest.raises(DataError, match=r"f3.csv: has frames of 6 x 7 cells, f0.csv of 5 x 7; "):
        frames_of(folder)


@pytest.mark.parametrize("other", ["notes.txt", "g0.csv"])
def test_a_folder_with_other_files_is_no_recording_and_names_them_by_number(
    folder: Path, other: str
) -> None:
    write(folder, "1,2", other)
    told = r"\(f0.csv, f1.csv, f2.csv, f3.csv, f4.csv, …\), or several in the order in which"
    with pytest.raises(DataError, match=told):
        frames_of(folder)


def test_files_that_come_out_of_the_order_of_their_numbers_are_told(folder: Path) -> None:
    paths = sorted(folder.glob("f*.csv"))
    frames, report = frames_of(paths)
    assert len(frames) == 12
    (where, what), *others = report.troubles
    assert not others
    assert where == str(folder / "f2.csv")
    assert what.startswith("is read after f11.csv, in the order in which the files are given")
    assert recording.ranges(path=paths) is None
    _, report = frames_of([folder / f"f{k}.csv" for k in (2, 3, 10, 11)])
    assert not report.troubles
