"""``--workers`` of other commands: what one process gives but for times, or why it cannot be."""

from __future__ import annotations

import csv
import json
import sqlite3
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from helpers_many import ran, ran_here, write_plugin

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
LATELY = """
pipeline: lately
about: Remembers a few frames, of those in which enough lies there
source: {step: sample}
conditions:
  much: mean > 26
nodes:
  footprint: {step: threshold, in: frame, with: {level_v: 0.01}}
  mean: {step: lately, in: frame, when: footprint.count > 30, with: {frames: 4}}
  boundary: {step: boundary_scan, in: footprint, when: much}
  circle: {step: fit_circle, in: boundary}
outputs: [circle]
"""
GUARDED = """
pipeline: guarded
about: Kills whoever runs one of its frames
nodes:
  image: {step: deadly, in: frame, with: {at: [7]}}
  footprint: {step: threshold, in: image, with: {level_v: 0.01}}
  boundary: {step: boundary_scan, in: footprint, when: footprint.count > 3}
outputs: [boundary]
"""
NEXT = """
pipeline: next
about: Every other frame of a recording is looked at
source: {step: sample}
conditions:
  early: n < 25
nodes:
  n: {step: counted, in: frame}
  footprint: {step: threshold, in: frame, with: {level_v: 0.01}}
  boundary: {step: boundary_scan, in: footprint, when: early}
  circle: {step: fit_circle, in: boundary}
outputs: [circle]
"""
pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("options")
    write_plugin(path)
    for name, text in (
        ("ladder", LADDER),
        ("lately", LATELY),
        ("next", NEXT),
        ("guarded", GUARDED),
    ):
        (path / f"{name}.yaml").write_text(text)
    got = ran_here(path, "convert", "a.npz", *DISCS, "--with", "frames=90")
    assert got.returncode == 0, got.stderr
    return path


@pytest.fixture(scope="module")
def stores(folder: Path) -> Path:
    """Return where two stores lie, of objects that pass and of discs."""
    pytest.importorskip("zarr", reason="the 'zarr' extra is not installed")
    for name, scene, n in (("p", "passing", 60), ("q", "discs", 80)):
        words = ("--source", "simulate", "--with", f"scene={scene}", "--with", f"frames={n}")
        got = ran_here(folder, "convert", f"{name}.zarr", *words, "--seed", str(n))
        assert got.returncode == 0, got.stderr
    return folder


def both(folder: Path, *words: str, here: bool = True) -> list[str]:
    """Run a command in one process and by two workers; ``{}`` in its words is another each time.

    Only where asked for are these processes of their own.
    """
    said = []
    for name, more in (("one", ()), ("two", ("--workers", "2"))):
        got = (ran_here if here else ran)(folder, *(w.format(name) for w in words), *more)
        assert got.returncode == 0, got.stderr
        said.append(got.stdout + got.stderr)
    return said


def test_compare(folder: Path) -> None:
    _, said = both(folder, "compare", "circle-1", "circle-3", "a.npz", "--csv", "{}.csv",
                   here=False)  # fmt: skip
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


@pytest.mark.parametrize(
    "words", [("compare", "guarded.yaml", "circle-1"), ("audit", "guarded.yaml")]
)
def test_frames_of_which_workers_died_are_counted_and_told(
    folder: Path, words: tuple[str, ...]
) -> None:
    got = ran_here(folder, *words, "a.npz", "--frames", "20", "--workers", "2",
                   "--json", "died.json")  # fmt: skip
    assert got.returncode == 1, got.stderr
    assert "; 1 of 20 frames left out: workers died" in " ".join(got.stdout.split())
    data = json.loads((folder / "died.json").read_text())
    assert (data["frames_left_out"] if words[0] == "audit" else data["frames"]["n_left_out"]) == 1


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


# -- steps that keep state ---------------------------------------------------------------------


def rows_of(path: Path) -> list[list[str]]:
    """Return what a file of errors says but for the frames' numbers and recordings, sorted."""
    with path.open() as file:
        rows = [*csv.DictReader(file)]
    return sorted([v for k, v in r.items() if k not in ("frame", "label")] for r in rows)


def succeeded(folder: Path, *words: str) -> str:
    got = ran_here(folder, *words)
    assert got.returncode == 0, got.stderr
    return got.stdout + got.stderr


@pytest.mark.parametrize("variants", [("tracks", "contacts"), ("next.yaml", "circle-1")])
def test_compare_gives_each_recording_to_one_worker(
    stores: Path, variants: tuple[str, str]
) -> None:
    for name in ("p", "q"):
        succeeded(stores, "compare", *variants, f"{name}.zarr", "--csv", f"{name}.csv")
    said = succeeded(stores, "compare", *variants, "p.zarr", "q.zarr", "--csv", "pq.csv",
                     "--workers", "2")  # fmt: skip
    assert "state starts anew with each" in said
    apart = rows_of(stores / "p.csv") + rows_of(stores / "q.csv")
    assert rows_of(stores / "pq.csv") == sorted(apart)
    assert "times were taken with 2 workers side by side" in " ".join(said.split())


@pytest.mark.parametrize("span", ["140", "17:133"])
def test_compare_goes_back_as_far_as_steps_remember(stores: Path, span: str) -> None:
    _, said = both(stores, "compare", "lately.yaml", "circle-1", "p.zarr", "q.zarr", "--frames",
                   span, "--csv", "lately-{}.csv", "--json", "lately-{}.json")  # fmt: skip
    one, two = (stores / f"lately-{n}.csv" for n in ("one", "two"))
    assert one.read_bytes() == two.read_bytes()
    answered = {r[6] for r in rows_of(one) if r[1] == "lately"}
    assert answered == {"0", "1"}  # by what was remembered, some are and some are not
    assert "in one process" not in said
    kept = [json.loads((stores / f"lately-{n}.json").read_text()) for n in ("one", "two")]
    assert [k["frames"] for k in kept] == [kept[0]["frames"]] * 2
    assert [c["position"] for c in kept[0]["chosen"]] == [c["position"] for c in kept[1]["chosen"]]


def test_audit_gives_each_recording_to_one_worker(stores: Path) -> None:
    for name in ("p", "q"):
        succeeded(stores, "audit", "next.yaml", f"{name}.zarr", "--json", f"{name}.json")
    said = succeeded(stores, "audit", "next.yaml", "p.zarr", "q.zarr", "--json", "pq.json",
                     "--workers", "2", "--sample", "0.5")  # fmt: skip
    assert "state starts anew with each" in said
    p, q, both = (json.loads((stores / f"{n}.json").read_text()) for n in ("p", "q", "pq"))
    assert (both["frames"], both["frames_seen"]) == (140, 140)
    for counted in ("n_stopped", "n_changed", "n_false_prevented"):
        sums = [a[counted] + b[counted] for a, b in zip(p["guards"], q["guards"], strict=True)]
        assert [g[counted] for g in both["guards"]] == sums
    assert both["guards"][0]["n_stopped"] == 60 + 80 - 2 * 24


def test_audit_goes_back_as_far_as_steps_remember(stores: Path) -> None:
    both(stores, "audit", "lately.yaml", "p.zarr", "q.zarr", "--json", "a-{}.json")
    one, two = (json.loads((stores / f"a-{n}.json").read_text()) for n in ("one", "two"))
    kept = [
        [(g["node"], g["n_stopped"], g["n_changed"], g["differences"]) for g in found["guards"]]
        for found in (one, two)
    ]
    assert kept[0] == kept[1]
    assert all(0 < g["n_stopped"] < 140 for g in one["guards"])


@pytest.mark.parametrize("command", [("compare", "circle-1"), ("audit",)], ids=lambda c: c[0])
def test_state_and_garbage_go_in_one_process(folder: Path, command: tuple[str, ...]) -> None:
    with np.load(folder / "a.npz") as held:
        kept = {k: held[k] for k in ("values", "pitch_cm", "origin_cm", "quantity")}
    kept["values"] = np.array(kept["values"])
    kept["values"][50] = 5.0 * np.random.default_rng(0).random(kept["values"].shape[1:])
    np.savez(folder / "garbage.npz", **kept)
    _, said = both(folder, *command, "lately.yaml", "garbage.npz")
    assert "in one process: steps keep state, and" in said
    assert "side by side" not in said


def test_a_worker_that_dies_of_a_frame_of_a_recording_is_told(stores: Path) -> None:
    (stores / "dies.yaml").write_text(NEXT.replace("in: frame,", "in: frame,", 1).replace(
        "{step: counted, in: frame}", "{step: counted, in: frame}\n  d: {step: deadly, in: frame, "
        "with: {at: [70]}}").replace("outputs: [circle]", "outputs: [circle, d]"))  # fmt: skip
    got = ran_here(stores, "compare", "dies.yaml", "circle-1", "p.zarr", "q.zarr", "--workers",
                   "2", "--csv", "dies.csv")  # fmt: skip
    assert got.returncode == 1, got.stderr
    assert "frame 70: workers died of it each time: left out" in got.stdout + got.stderr
    with (stores / "dies.csv").open() as file:
        frames = {int(row["frame"]) for row in csv.DictReader(file)}
    assert 70 not in frames
    assert {69, 71, 139} <= frames


def test_what_keeps_state_stays_in_one_process_and_says_so(folder: Path) -> None:
    got = ran_here(folder, "compare", "tracks", "--frames", "5", "--workers", "2")
    assert got.returncode == 0
    assert "in one process:" in got.stderr
    assert "keeps state from frame to frame" in got.stderr


def test_a_worker_that_dies_of_a_frame_is_told(folder: Path) -> None:
    got = ran_here(folder, "compare", "deadly.yaml --set image.at=[7]", "circle-1", "a.npz",
              "--frames", "20", "--workers", "2", "--csv", "dead.csv")  # fmt: skip
    assert got.returncode == 1, got.stderr
    assert "frame 7: workers died of it each time: left out" in got.stdout + got.stderr


def test_no_more_workers_are_told_than_are_started() -> None:
    from tactile_graph.cli.many.options import side_by_side
    from tactile_graph.many.executor_kind import place_of
    from tactile_graph.many.processes import most_workers

    assert f"with {most_workers()} workers side" in side_by_side(place_of(None, 100_000))
