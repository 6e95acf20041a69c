"""A folder gets the name of an older one at once."""

from __future__ import annotations

import sys
import threading
from pathlib import Path

import pytest

from tactile_graph.cli.output import array_files
from tactile_graph.cli.output.array_files import put_in_place


def folder(path: Path, text: str) -> Path:
    path.mkdir()
    (path / "what").write_text(text)
    return path


@pytest.mark.parametrize("at_once", [True, False])
def test_a_folder_takes_the_place_of_another_and_nothing_is_left_beside_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, at_once: bool
) -> None:
    if not at_once:  # as where the system cannot exchange two names
        monkeypatch.setattr(array_files, "_exchanged", lambda one, other: False)
    part, target = folder(tmp_path / ".a.part", "new"), folder(tmp_path / "a", "old")
    put_in_place(part, target)
    assert (target / "what").read_text() == "new"
    assert [p.name for p in tmp_path.iterdir()] == ["a"]


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="other systems do not exchange two names")
def test_at_no_moment_is_there_no_folder_of_that_name(tmp_path: Path) -> None:
    target, over, missed = folder(tmp_path / "a", "0"), threading.Event(), 0

    def look() -> None:
        nonlocal missed
        while not over.is_set():
            missed += not target.exists()

    watcher = threading.Thread(target=look)
    watcher.start()
    for i in range(1, 400):
        put_in_place(folder(tmp_path / ".a.part", str(i)), target)
    over.set()
    watcher.join()
    assert (missed, (target / "what").read_text()) == (0, "399")
