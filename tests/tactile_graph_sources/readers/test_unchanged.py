"""Files that are written while they are read."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from tactile_graph.errors import DataError
from tactile_graph.steps.injected import Report
from tactile_graph_sources.recording import recording

WRITTEN = "changed while it was read"


def table(n_lines: int, value: int) -> str:
    return "".join(",".join([str(value + k % 7), *["1"] * 15]) + "\n" for k in range(n_lines))


def read_and(then: Callable[[], object], path: Path) -> tuple[int, Report]:
    report = Report()
    frames = recording(path=path, rows=4, columns=4, report=report)
    next(frames)
    then()
    return 1 + sum(1 for _ in frames), report


@pytest.mark.parametrize("n_lines", [400, 4000, 5000, 300])
def test_one_that_is_written_anew_is_refused(tmp_path: Path, n_lines: int) -> None:
    path = tmp_path / "a.csv"
    path.write_text(table(4000, 2))
    with pytest.raises(DataError, match=WRITTEN):
        read_and(lambda: path.write_text(table(n_lines, 5)), path)


def test_that_is_told_in_place_of_what_it_did_to_the_reading(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text(table(4000, 2))
    broken = ("1,2\n" * 400).join(["", ""])
    with pytest.raises(DataError, match=WRITTEN):
        read_and(lambda: path.write_text(broken), path)


def test_a_part_of_a_folder_is_named(tmp_path: Path) -> None:
    for k in range(3):
        (tmp_path / f"f{k}.csv").write_text(table(400, 2))
    with pytest.raises(DataError, match=rf"f0\.csv: {WRITTEN}"):
        read_and(lambda: (tmp_path / "f0.csv").write_text(table(90, 5)), tmp_path)


def test_one_that_only_grew_is_read_and_that_is_told(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text(table(400, 2))
    with path.open("a") as file:
        n, report = read_and(lambda: (file.write(table(9, 2)), file.flush()), path)
    assert n >= 400
    assert report.troubles == [
        (str(path), "grew while it was read: what was added may be left out")
    ]


def test_one_that_was_removed_or_only_read_is_as_it_was(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text(table(400, 2))
    for then in (path.read_text, path.unlink):
        n, report = read_and(then, path)
        assert (n, report.troubles) == (400, [])
