"""The benchmark suite's own arithmetic: result files, references, verdicts that know noise."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

FOLDER = Path(__file__).parents[2] / "benchmarks"
sys.path.insert(0, str(FOLDER))
from suite_parts import fits, frames, records, stream  # noqa: E402
from suite_parts.scenes import SCENES, scene  # noqa: E402
from suite_parts.verdict import references, verdicts  # noqa: E402

from tactile_graph import load  # noqa: E402


def results(
    factor: float = 1.0, drift: float = 1.0, shift: float = 0.0, seed: int = 0, frames_seed: int = 0
) -> records.Results:
    """Ours and a peer over 11 rounds of a drifting machine, with errors over 30 frames."""
    rng = np.random.default_rng(seed)
    machine = drift * np.exp(0.2 * rng.normal(size=11))
    noise = np.exp(0.02 * rng.normal(size=(2, 11)))
    error = 0.3 + 0.1 * np.random.default_rng(frames_seed).random(30) + shift
    both = [
        records.Measured(
            "scenes", "clean 16", "circle-3", tuple(30.0 * factor * machine * noise[0]),
            {"centre_cm": (None, *error)},
        ),
        records.Measured("scenes", "clean 16", "OpenCV script", tuple(90.0 * machine * noise[1])),
    ]  # fmt: skip
    return replace(records.results_of(both, frames_seed), made="2026-01-01")


def test_a_result_file_comes_back_whole(tmp_path: Path) -> None:
    path = tmp_path / "results.json"
    made = results()
    records.write(made, path)
    assert records.read(path) == made
    assert [p.name for p in tmp_path.iterdir()] == ["results.json"]


@pytest.mark.parametrize("text", ["", "{}", "[1]", '{"format": 99}'])
def test_another_file_is_refused(tmp_path: Path, text: str) -> None:
    path = tmp_path / "other.json"
    path.write_text(text)
    with pytest.raises(ValueError, match=r"other\.json: not a result file"):
        records.read(path)


def test_the_peer_is_the_reference_though_it_comes_second() -> None:
    assert references(results())["scenes", "clean 16"].contestant == "OpenCV script"


@pytest.mark.parametrize(
    ("factor", "word"), [(1.0, "same"), (1.3, "slower"), (0.7, "faster"), (1.02, "same")]
)
def test_a_change_of_time_is_seen_through_a_machine_twice_as_slow(factor: float, word: str) -> None:
    found = verdicts(results(seed=1), results(factor, drift=2.0, seed=2))
    (time,) = [v for v in found if v.what == "time"]
    assert time.word == word
    assert time.low < time.ratio < time.high
    assert time.ratio == pytest.approx(factor, rel=0.05)


@pytest.mark.slow
def test_no_change_is_hardly_ever_called_one() -> None:
    words = [
        v.word
        for s in range(60)
        for v in verdicts(results(seed=2 * s), results(drift=1.5, seed=2 * s + 1))
    ]
    assert {w for w in words if w != "same"} <= {"unsure"}


@pytest.mark.parametrize(("shift", "word"), [(0.0, "same"), (0.01, "worse"), (-0.01, "better")])
def test_errors_of_the_same_frames_are_paired(shift: float, word: str) -> None:
    """A hundredth of a centimetre, where errors scatter by three, shows only in pairs."""
    found = verdicts(results(), results(shift=shift))
    (error,) = [v for v in found if v.what == "centre_cm"]
    assert error.word == word
    assert error.ratio == pytest.approx(shift, abs=1e-12)


def test_errors_of_other_frames_are_not_paired() -> None:
    found = verdicts(results(), results(shift=0.01, frames_seed=5))
    assert [v.word for v in found if v.what == "centre_cm"] == ["same"]


@pytest.mark.parametrize("name", SCENES)
def test_scenes_hold_what_they_are_named_for(name: str) -> None:
    made = scene(name, 16, 2, seed=0)
    shapes = [[type(t.shape).__name__ for t in f.truth or ()] for f in made.frames]
    expected = {"empty": [], "two objects": ["Circle", "Rectangle"]}.get(name, ["Circle"])
    assert shapes == [expected, expected]
    lit = [(f.image.values > 0.01).sum() for f in made.frames]
    assert all(n == 0 for n in lit) if name == "empty" else all(n > 15 for n in lit)
    if name == "dead row":
        assert all((f.image.values[7] < 0.01).all() for f in made.frames)


def test_a_larger_pad_shows_the_same_scene_finer() -> None:
    small, large = (scene("clean", n, 1, seed=0).frames[0] for n in (16, 48))
    ratio = (large.image.values > 0.01).sum() / (small.image.values > 0.01).sum()
    assert ratio == pytest.approx(9, rel=0.15)


@pytest.mark.slow
def test_a_small_run_measures_pipelines_and_peers_alike(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(frames, "PIPELINES", ("circle-3",))
    monkeypatch.setattr(frames, "SCENES", ("empty", "clean"))
    found = list(frames.measured((16,), 2, 3, 0, lambda _: None))
    circle = {m.case: m for m in found if m.contestant == "circle-3"}
    assert circle["empty 16"].error("false alarms") == 0.0
    assert circle["clean 16"].error("radius_cm") is not None
    assert (circle["empty 16"].nodes_run or 0) < (circle["clean 16"].nodes_run or 0) == 7
    assert all(len(m.rounds_us) == 3 for m in found)


@pytest.mark.slow
def test_a_stream_is_mostly_empty_and_mixed() -> None:
    made = stream.stream(100, seed=0)
    counts = {c: made.classes.count(c) for c in made.classes}
    assert counts == {"empty": 80, "clean": 15, **dict.fromkeys(stream.HARD, 1)}
    assert [f.index for f in made.frames] == list(range(100))
    assert all(
        bool(f.truth) is (c != "empty") for f, c in zip(made.frames, made.classes, strict=True)
    )
    assert made.classes != tuple(sorted(made.classes))
    assert made.at("hard") == tuple(i for i, c in enumerate(made.classes) if c in stream.HARD)
    assert made.at(stream.WHOLE) == tuple(range(100))
    assert stream.stream(100, seed=1).classes != made.classes


@pytest.mark.slow
def test_a_stream_is_measured_whole_and_in_parts(monkeypatch: pytest.MonkeyPatch) -> None:
    """Empty frames are cheap, counted as false alarms; each frame's time is in one part."""
    circle = load("circle-3")
    monkeypatch.setattr(stream, "pipelines", lambda: {"a": circle, "b": stream.ungated(circle)})
    found = {(m.contestant, m.case): m for m in stream.measured(40, 3, 0, lambda _: None)}
    whole, empty, hard = (found["a", c] for c in (stream.WHOLE, "empty", "hard"))
    parts = [m for (who, _), m in found.items() if who == "a" and m.at]
    assert sorted(i for m in parts for i in m.at) == list(range(43))
    assert all(len(m.frames_us) == len(m.at) for m in parts)
    assert len(whole.errors["centre_cm"]) == 6 + len(hard.errors["centre_cm"]) == 11
    assert empty.errors == {"false alarms": (0.0,) * 32}
    assert empty.nodes_run == 1
    assert (found["b", "empty"].nodes_run or 0) > 1
    # which may be reckoned by a kernel's plain reference and by its compiled twin
    ours, theirs = (found[name, "clean"].errors for name in "ab")
    assert set(ours) == set(theirs)
    for quantity in ours:
        assert ours[quantity] == pytest.approx(theirs[quantity], rel=1e-9)


def test_fits_are_scored_on_known_shapes() -> None:
    (case,) = [c for c in fits.circle_cases(3, 0) if c.name == "arc of 360 degrees"]
    chosen = {"k": fits.circle_fits()["fit_circle_kasa"]}
    (kasa,) = fits._raced("circle fits", case, chosen, 3)
    error = kasa.error("radius_cm")
    assert error is not None
    assert error < 0.1
