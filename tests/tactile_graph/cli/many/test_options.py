"""``--workers`` of other commands: what one process gives but for times, or why it cannot be."""

from __future__ import annotations

import json
import sqlite3
from pathlib import Path
from typing import Any

import pytest

from helpers_many import ran, write_plugin

DISCS = ("--source", "simulate", "--with", "scene=discs")
LADDER = """
pipeline: ladder
about: The scan answers where it is sure of it
source: {step: simulate, with: {scene: discs}}
nodes:
  footprint: {step: threshold, in: frame, with: {level_v: 0.01}}
  boundary: {step: boundary_scan, in: footprint, when: footprint.count > 12}
  quick: {step: fit_circle, in: boundary}
  hull: {step: hull, in: boundary}
  slow: {step: fit_circle, in: hull.points}
  circle: {first_of: [quick, slow]}
outputs: [circle]
"""
pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("options")
    write_plugin(path)
    (path / "ladder.yaml").write_text(LADDER)
    got = ran(path, "convert", "a.npz", *DISCS, "--with", "frames=90")
    assert got.returncode == 0, got.stderr
    return path


def both(folder: Path, *words: str) -> list[str]:
    """Run a command in one process and by two workers; ``{}`` in its words is another each time."""
    said = []
    for name, more in (("one", ()), ("two", ("--workers", "2"))):
        got = ran(folder, *(w.format(name) for w in words), *more)
        assert got.returncode == 0, got.stderr
        said.append(got.stdout + got.stderr)
    return said


def test_compare(folder: Path) -> None:
    _, said = both(folder, "compare", "circle-1", "circle-3", "a.npz", "--csv", "{}.csv")
    assert (folder / "one.csv").read_bytes() == (folder / "two.csv").read_bytes()
    assert len((folder / "one.csv").read_text().splitlines()) > 90
    assert "times were taken with 2 workers side by side" in " ".join(said.split())


def test_audit(folder: Path) -> None:
    both(folder, "audit", "circle-3", "a.npz", "--sample", "0.5", "--json", "{}.json")
    one, two = (json.loads((folder / f"{n}.json").read_text()) for n in ("one", "two"))
    assert [one["frames"], one["frames_seen"]] == [two["frames"], two["frames_seen"]]
    kept = [
        [(g["node"], g["n_stopped"], g["n_changed"], g["differences"]) for g in found["guards"]]
        for found in (one, two)
    ]
    assert kept[0] == kept[1]


def test_learn(folder: Path) -> None:
    both(folder, "learn", "disc", "a.npz", "--database", "{}.sqlite")

    def readings(name: str) -> list[Any]:
        with sqlite3.connect(folder / f"{name}.sqlite") as database:
            return list(database.execute("SELECT * FROM reading_values"))

    assert readings("one") == readings("two")
    assert len(readings("one")) > 500


def test_tune(folder: Path) -> None:
    _, said = both(folder, "tune", "ladder.yaml", "--frames", "24", "--rounds", "1", "--json",
                   "{}.json")  # fmt: skip
    one, two = (json.loads((folder / f"{n}.json").read_text()) for n in ("one", "two"))
    given = [d["points"]["as given"]["run"]["error"]["mean"] for d in (one, two)]
    table = [d["points"]["as given"]["predicted"]["error"]["mean"] for d in (one, two)]
    assert given[0] == given[1]
    assert table[0] == table[1]
    assert "of the table times were taken with 2 workers" in " ".join(said.split())


def test_reproduce(folder: Path) -> None:
    both(folder, "reproduce", "table-4.5", "figure-4.3", "-o", "{}", "--readings", "20")
    one, two = (
        {p.name: p.read_bytes() for p in (folder / name).iterdir()} for name in ("one", "two")
    )
    assert one == two
    assert len(one) > 4


def test_what_keeps_state_stays_in_one_process_and_says_so(folder: Path) -> None:
    got = ran(folder, "compare", "tracks", "--frames", "5", "--workers", "2")
    assert got.returncode == 0
    assert "in one process:" in got.stderr
    assert "keeps state from frame to frame" in got.stderr


def test_a_worker_that_dies_of_a_frame_is_told(folder: Path) -> None:
    got = ran(folder, "compare", "deadly.yaml --set image.at=[7]", "circle-1", "a.npz",
              "--frames", "20", "--workers", "2", "--csv", "dead.csv")  # fmt: skip
    assert got.returncode == 0, got.stderr
    assert "frame 7: workers died of it each time: left out" in got.stdout + got.stderr
