"""Which frame of its recording a frame is, where others were left out."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from helpers_recordings import (
    blobs,
    flat_text,
    frames_of,
    npy_bytes,
    npz_bytes,
    popu_bed_text,
    stacked_text,
    tekscan_text,
    write,
)
from tactile_graph import Frame
from tactile_graph.steps import Report
from tactile_graph_sources.recording import recording

N = 12
SMOOTH = np.array([np.add.outer(np.arange(6.0), np.arange(7.0)) + 0.01 * k for k in range(N)])


def cut(text: str, line: int) -> str:
    lines = text.splitlines()
    lines[line] = lines[line][: len(lines[line]) // 3]
    return "\n".join(lines) + "\n"


def flat() -> str:
    return cut(flat_text(blobs(N, 6, 7)), 4)


def first_line_cut() -> str:
    lines = flat_text(blobs(N, 6, 7)).splitlines()
    lines[0] = lines[0].partition(",")[2].partition(",")[2]
    return "\n".join(lines) + "\n"


def stacked() -> str:
    return cut(stacked_text(blobs(N, 6, 7)), 4 * 7 + 2)


def tekscan() -> str:
    text = tekscan_text(blobs(N, 6, 7))
    head, fifth, rest = text.partition("Frame 5")
    return head + fifth + rest.replace("\n", "\nbroken,", 2)


def json_lines() -> str:
    lines = [json.dumps({"t": k, "cells": v.tolist()}) for k, v in enumerate(blobs(N, 6, 7))]
    lines[4] = lines[4][:50]
    return "\n".join(lines) + "\n"


def bed() -> str:
    record = json.loads(popu_bed_text(np.ones((N, 64, 27), np.int64)))
    shots = record["snapshots"]
    key = list(shots)[4] if isinstance(shots, dict) else 4
    shots[key]["tactilus_readings"] = [1, 2]
    return json.dumps(record)


SETTINGS: dict[Any, dict[str, int]] = {flat: {"rows": 6, "columns": 7}}


@pytest.mark.parametrize("text", [flat, stacked, tekscan, json_lines, bed])
def test_a_damaged_frame_keeps_its_place(text: Callable[[], str], tmp_path: Path) -> None:
    frames, report = frames_of(write(tmp_path, text()), **SETTINGS.get(text, {}))
    assert [f.index for f in frames] == [*range(N - 1)]
    assert [f.place for f in frames] == [k for k in range(N) if k != 4]
    assert [f.gap for f in frames] == [k == 4 for k in range(N - 1)]
    assert report.n_places == N


def test_a_first_line_that_is_cut_is_a_frame_and_a_line_of_a_shape_is_none(tmp_path: Path) -> None:
    told = {"rows": 6, "columns": 7}
    frames, _ = frames_of(write(tmp_path, first_line_cut()), **told)
    assert [f.place for f in frames] == [*range(1, N)]
    frames, _ = frames_of(write(tmp_path, "6 7\n" + flat_text(blobs(N, 6, 7))), **told)
    assert [f.place for f in frames] == [*range(N)]


def test_words_among_the_frames_are_none(tmp_path: Path) -> None:
    lines = flat_text(blobs(N, 6, 7)).splitlines()
    lines.insert(4, "the sensor was reset")
    frames, report = frames_of(write(tmp_path, "\n".join(lines)), rows=6, columns=7)
    assert [f.place for f in frames] == [*range(N)]
    assert (frames[4].gap, report.n_places) == (True, N)


def test_garbage_and_what_is_skipped_keep_their_places(tmp_path: Path) -> None:
    values = SMOOTH.copy()
    values[5] = np.random.default_rng(1).uniform(0, 1000, (6, 7))
    frames, report = frames_of(write(tmp_path, npz_bytes(a=values)), skip=2)
    assert [f.place for f in frames] == [k for k in range(2, N) if k != 5]
    assert report.n_places == N


@pytest.mark.parametrize("form", ["frames", "stacks", "ranges"])
def test_places_go_on_from_file_to_file(form: str, tmp_path: Path) -> None:
    paths = [write(tmp_path, npy_bytes(SMOOTH + k), f"film{k}.npy") for k in range(2)]
    told = {"rows": 6, "columns": 7, "skip": 2}
    if form == "frames":
        found = frames_of(paths, **told)[0]
    elif form == "ranges":
        ranges = recording.ranges(path=paths, **told)  # type: ignore[attr-defined]
        found = [*ranges.read(0, 2 * (N - 2))]
    else:
        columns = ("frame_column", "time_column", "value_column", "cells", "time_unit")
        rest = {"time_format": "", "report": Report(), **dict.fromkeys(columns, "")}
        del told["skip"]
        some = recording.stacked(path=paths, **told, **rest)  # type: ignore[attr-defined]
        found = [f for s in some for f in (s if hasattr(s, "images") else [s])]
    skipped = told.get("skip", 0)
    expected = [*range(skipped, N), *range(N + skipped, 2 * N)]
    assert [f.place for f in found] == expected


@pytest.mark.parametrize(("n", "expected"), [(1, [0, 1, 3, 4]), (2, [*range(8)])])
def test_a_file_of_a_folder_without_a_whole_frame_is_one_where_each_holds_one(
    n: int, expected: list[int], tmp_path: Path
) -> None:
    for k, frame in enumerate(blobs(5, 6, 7)):
        text = tekscan_text(np.stack([frame + i for i in range(n)]))
        write(tmp_path, text.partition("Frame 1")[0] if k == 2 else text, f"f{k}.asf")
    frames, report = frames_of(tmp_path)
    assert [f.place for f in frames] == expected
    assert report.counts["damaged records skipped"] == 1


def test_places_go_on_in_a_folder(tmp_path: Path) -> None:
    for k in range(2):
        write(tmp_path, flat(), f"f{k}.csv")
    frames, _ = frames_of(tmp_path, rows=6, columns=7)
    assert [f.place for f in frames] == [k for k in range(2 * N) if k % N != 4]


def test_what_a_store_lost_keeps_its_places(tmp_path: Path) -> None:
    pytest.importorskip("zarr", reason="the 'zarr' extra is not installed")
    from tactile_graph_sources.writers.write_store import StoreWriter

    path = tmp_path / "a.zarr"
    with StoreWriter(path, chunk=4) as writer:
        for k in range(N):
            writer.write(Frame.of(SMOOTH[k], index=k))
    (path / "values" / "c" / "1" / "0" / "0").unlink()
    assert [f.place for f in frames_of(path)[0]] == [0, 1, 2, 3, 8, 9, 10, 11]


def test_the_files_own_numbers_are_kept(tmp_path: Path) -> None:
    lines = [",".join([str(2 * k + 1), *row.split(",")]) for k, row in
             enumerate(flat_text(blobs(N, 6, 7)).splitlines())]  # fmt: skip
    head = "frame," + ",".join(f"r{r}c{c}" for r in range(6) for c in range(7))
    frames, _ = frames_of(write(tmp_path, "\n".join([head, *lines])))
    assert [f.own_number for f in frames] == [*range(1, 2 * N, 2)]
    assert [f.place for f in frames] == [*range(N)]
    frames, _ = frames_of(write(tmp_path, tekscan_text(blobs(N, 6, 7))))
    assert [f.own_number for f in frames] == [*range(1, N + 1)]
