"""A data set has a part for each recording, whole ones alone, and everyone reads it."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from helpers_cli import call
from tactile_graph.cli.output import data_set
from tactile_graph.cli.output.data_set import LONGEST_NAME, _unit_told, folder_of, manifest_of
from tactile_graph.engine.tables.columns import Column
from tactile_graph.locks import Lock

HOSTILE = ("007", "a=b&c%20.txt", "größe 日本.txt", "line\nbreak.txt", "__HIVE_DEFAULT_PARTITION__",
           "it's \"q\".txt", "A.txt", "a.txt", "NULL", "..txt", "ü" * 110 + ".txt")  # fmt: skip


LOAD = """
pipeline: pressed
source: {step: simulate, with: {scene: discs}}
nodes: {load: {step: load, in: frame, with: {above: 0.01}}}
outputs: [load]
"""


@pytest.fixture(autouse=True)
def _here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("pyarrow")
    monkeypatch.chdir(tmp_path)
    # It would compile the kernels for every test that comes after.
    monkeypatch.setattr("tactile_graph.compiled.warm_up", lambda: None)
    Path("pressed.yaml").write_text(LOAD)


def recordings(*names: str, frames: int = 2) -> list[str]:
    for name in names:
        Path(name).parent.mkdir(parents=True, exist_ok=True)
        with Path(name).open("wb") as file:
            np.save(file, np.random.default_rng(1).random((frames, 4, 5)))
    return list(names)


def run(*names: str, to: str = "results/", more: tuple[str, ...] = (), frames: int = 2) -> Any:
    told = ("--with", "quantity=volt", *more)
    return call("run", "pressed.yaml", *recordings(*names, frames=frames), *told, "-o", to)


def rows(folder: str = "results") -> dict[str, int]:
    """Return how many rows each recording has, as pyarrow's own reader of data sets finds them."""
    import pyarrow.dataset

    found = pyarrow.dataset.dataset(folder, partitioning="hive").to_table()["recording"]
    assert found.type == "string"
    return {row["values"]: row["counts"] for row in found.value_counts().to_pylist()}


@pytest.mark.slow
def test_each_recording_has_a_part_and_the_manifest_names_it() -> None:
    done = run("left.txt", "right.txt", frames=3)
    assert done.exit_code == 0, done.output
    assert rows() == {"left.txt": 3, "right.txt": 3}
    manifest = manifest_of(Path("results"))
    assert manifest is not None
    assert manifest["pipeline"] == "pressed"
    for entry in manifest["recordings"].values():
        (part,) = entry["files"]
        path = Path("results") / entry["folder"] / part["name"]
        assert (entry["frames"], part["bytes"]) == (3, path.stat().st_size)
    assert json.loads(Path("results.meta.json").read_text())["complete"]


def test_one_recording_and_no_recording_have_names_too() -> None:
    run("only.txt")
    assert rows() == {"only.txt": 2}
    assert call("run", "pressed.yaml", "--frames", 2, "-o", "made.dataset").exit_code == 0
    assert rows("made.dataset") == {"simulate": 2}


def test_recordings_of_one_name_in_two_folders_are_two() -> None:
    run("monday/press.npy", "tuesday/press.npy")
    assert rows() == {"monday/press.npy": 2, "tuesday/press.npy": 2}


def test_hostile_names_come_back_as_they_are_or_by_the_manifest() -> None:
    assert run(*HOSTILE).exit_code == 0
    manifest = manifest_of(Path("results"))
    assert manifest is not None
    assert set(manifest["recordings"]) == set(HOSTILE)
    folders = [entry["folder"] for entry in manifest["recordings"].values()]
    assert len({f.casefold() for f in folders}) == len(HOSTILE)
    found = rows()
    assert set(found.values()) == {2}
    told = {name for name in HOSTILE if name in found}
    assert set(HOSTILE) - told == {"007", "__HIVE_DEFAULT_PARTITION__", "a.txt", HOSTILE[-1]}
    assert {"007~", "__HIVE_DEFAULT_PARTITION__~"} <= set(found)


@pytest.mark.slow
@settings(max_examples=30)
@given(st.lists(st.text(min_size=1, max_size=300), unique=True, max_size=4))
def test_folders_of_any_names_differ_and_fit_every_file_system(names: list[str]) -> None:
    taken: dict[str, str] = {}
    for name in names:
        folder = folder_of(name, taken)
        assert folder.casefold() not in taken
        taken[folder.casefold()] = name
        assert folder.isascii()
        assert not set(folder) & set('/\\:*?"<>| \n')
        assert len(folder) < LONGEST_NAME + 40
        assert folder == folder_of(name, {folder.casefold(): name})


@pytest.mark.slow
@pytest.mark.parametrize("reader", ["pandas", "polars", "duckdb"])
def test_others_read_it(reader: str) -> None:
    module = pytest.importorskip(reader)
    run("a=b&c.txt", "größe.txt", "007")
    if reader == "pandas":
        names = module.read_parquet("results")["recording"].tolist()
    elif reader == "polars":
        found = module.scan_parquet("results/**/*.parquet", hive_partitioning=True).collect()
        names = found["recording"].to_list()
    else:
        asked = "select recording from read_parquet('results/**/*.parquet', hive_partitioning=true)"
        names = [name for (name,) in module.sql(asked).fetchall()]
    assert sorted(names) == ["007~"] * 2 + ["a=b&c.txt"] * 2 + ["größe.txt"] * 2


def test_a_recording_run_again_replaces_its_part_and_the_others_stay() -> None:
    run("left.txt", "right.txt")
    assert run("left.txt", frames=5).exit_code == 0
    assert rows() == {"left.txt": 5, "right.txt": 2}


def test_older_rows_stay_where_a_run_ends_within_their_recording(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    from tactile_graph.cli.commands.run import _Run

    run("left.txt", frames=5)
    real = _Run._results

    def results(self: _Run) -> Iterator[object]:
        yield next(real(self))
        signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr(_Run, "_results", results)
    got = run("left.txt", "right.txt", frames=5)
    assert got.exit_code == 130
    assert "of what was under way, left.txt, the older rows stay" in got.stderr
    assert rows() == {"left.txt": 5}
    assert [p.name for p in Path("results").rglob(".part*")] == []


def test_rows_of_a_recording_that_came_to_its_end_replace_the_older_where_a_run_ends_later(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    from tactile_graph.cli.commands.run import _Run

    run("left.txt", "right.txt")
    n = rows()["left.txt"]
    older = {p: p.stat().st_mtime_ns for p in Path("results").rglob("*.parquet")}
    real = _Run._results

    def results(self: _Run) -> Iterator[object]:
        yield from islice(real(self), n + 1)
        signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr(_Run, "_results", results)
    got = run("left.txt", "right.txt")
    assert got.exit_code == 130
    assert "of what was under way, right.txt, the older rows stay" in got.stderr
    newer = {p: p.stat().st_mtime_ns for p in older}
    assert [p.parent.name for p in older if newer[p] != older[p]] == ["recording=left.txt"]


def test_a_recording_that_goes_on_after_others_has_another_part(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(data_set, "IDLE_FRAMES", 2)
    run("a.txt", "b.txt", frames=6)
    assert rows() == {"a.txt": 6, "b.txt": 6}


def test_results_of_other_settings_are_not_mixed_in() -> None:
    run("left.txt")
    done = run("left.txt", more=("--set", "load.above=0.2"))
    assert done.exit_code == 2
    assert "-o results: holds results of 'pressed', as it was then: another pip" in done.stderr
    assert rows() == {"left.txt": 2}


@pytest.mark.parametrize(
    ("made", "said"),
    [
        (lambda: Path("results").write_text("x"), "-o results: is a file"),
        (lambda: Path("results/mine").mkdir(parents=True), "is a folder with something else in it"),
        (lambda: None, "there is no folder"),
    ],
    ids=["file", "folder", "none"],
)
def test_what_is_no_data_set_is_left_alone(made: Any, said: str) -> None:
    made()
    where = "no/where/results/" if said == "there is no folder" else "results/"
    done = run("left.txt", to=where)
    assert done.exit_code == 2
    assert said in done.stderr


def test_two_runs_do_not_write_into_one_at_once() -> None:
    run("left.txt")
    lock = Lock("results/.lock")
    assert lock.take()
    done = run("right.txt")
    lock.release()
    assert done.exit_code == 2
    assert "results: another run is writing into it" in done.stderr
    assert rows() == {"left.txt": 2}


def test_what_a_killed_run_left_of_the_manifest_is_cleared_up() -> None:
    assert run("left.txt").exit_code == 0
    left = Path("results", "._manifest.json.1.part")
    left.write_bytes(b"{")
    assert run("left.txt").exit_code == 0
    assert not left.exists()


def test_a_folder_as_output_says_how_a_data_set_is_asked_for() -> None:
    Path("results").mkdir()
    done = run("left.txt", to="results")
    assert (
        "-o results: is a folder; name a file in it, or end it in / for a data set" in done.stderr
    )


@pytest.mark.slow
def test_a_killed_run_leaves_whole_parts_alone_and_the_next_one_clears_up(tmp_path: Path) -> None:
    pq = pytest.importorskip("pyarrow.parquet")
    names = [f"r{k}.npy" for k in range(6)]
    recordings(*names, frames=1000)
    command = [sys.executable, "-c", "from tactile_graph.cli import main; main()", "run"]
    command += ["pressed.yaml", *names, "--with", "quantity=volt", "-o", "results/"]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    end = time.monotonic() + 120
    while (
        process.poll() is None
        and time.monotonic() < end
        and len([*Path("results").glob("*/part-*.parquet")]) < 2
    ):
        time.sleep(0.02)
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    parts = [*Path("results").glob("*/*.parquet")]
    assert 2 <= len(parts) < 6
    assert all(pq.ParquetFile(part).metadata.num_rows == 1000 for part in parts)
    manifest = manifest_of(tmp_path / "results")
    assert manifest is not None
    assert len(parts) - len(manifest["recordings"]) in (0, 1)
    assert subprocess.run(command, capture_output=True, check=False).returncode in (0, 1)
    assert not [*Path("results").rglob("*.part")]
    assert len([*Path("results").glob("*/*.parquet")]) == 6


@pytest.mark.parametrize(
    ("column", "told"),
    [
        (Column("angle_error_deg", "fit", "angle", "°", float, "angle"), "deg"),
        (Column("fit.angle_error_deg", "fit", "angle", "°", float, "angle"), "°"),
        (Column("fit.angle_rad", "fit", "angle", "rad", float), "rad"),
    ],
)
def test_sets_of_earlier_versions_have_the_units_of_long_errors_by_their_names(
    column: Column, told: str
) -> None:
    assert _unit_told(column) == told
