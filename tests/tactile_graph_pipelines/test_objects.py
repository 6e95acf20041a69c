"""Several objects by the shipped pipelines: told apart, placed, tracked, on a pad and a panel."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tactile_graph import Frame, load
from tactile_graph.engine.outcome import Skipped
from tactile_graph.engine.result import Result
from tactile_graph_tracking.score_objects import ObjectScore, score_objects

CAPCONTACT = Path(__file__).parents[2].parent / "shared/data/capcontact"


def score_of(result: Result) -> ObjectScore:
    return score_objects(result.frame, result["objects"].contacts)


def test_six_objects_that_do_not_touch_are_counted_and_placed() -> None:
    pipeline = load("objects").with_source("simulate", scene="six", frames=24)
    scores = [score_of(r) for r in pipeline.stream(seed=1)]
    assert len(scores) == 24
    assert np.mean([s.count_right for s in scores]) >= 0.9
    assert np.mean([s.mean_error_cm for s in scores]) < 0.5
    assert np.mean([s.n_paired for s in scores]) >= 5.8


def test_each_object_gets_a_shape_near_its_true_place() -> None:
    pipeline = load("objects").with_source("simulate", scene="six", frames=20)
    errors: list[float] = []
    for result in pipeline.stream(seed=5):
        shapes = result["shapes"]
        assert len(shapes) == result["objects"].count
        assert {s.kind for s in shapes} <= {"disc", "ellipse", "rectangle", "polygon"}
        errors += [e for _, _, e in score_objects(result.frame, shapes).pairs]
    assert len(errors) >= 0.93 * 20 * 6
    assert np.mean(errors) < 0.4


def test_one_to_six_objects_come_in_turn() -> None:
    scores = [score_of(r) for r in load("objects").stream(seed=0)]
    assert [s.n_true for s in scores[:6]] == [1, 2, 3, 4, 5, 6]
    assert np.mean([abs(s.n_found - s.n_true) for s in scores]) < 1.0


def test_an_empty_pad_has_no_objects_and_nothing_is_fitted() -> None:
    empty = Frame.of(np.zeros((16, 16)), 1.3, (-0.15, -0.15), "volt", truth=())
    result = load("objects").run(empty)
    assert isinstance(result.outcome("objects"), Skipped)
    assert isinstance(result.outcome("shapes"), Skipped)
    assert not result.failures


def test_the_tracker_tells_who_stays_who_slides_by_and_who_comes_and_goes() -> None:
    states: dict[int, list[str]] = {}
    results = list(load("tracks").stream(seed=0))
    for result in results:
        for track in result["tracks"].tracks:
            states.setdefault(track.id, []).append(track.state)
    assert [r["tracks"].count for r in results] == [2, 2, 2, 3, 3, 3, 3, 2, 2]
    assert len(states) == 3
    coin, disc, plate = states[1], states[2], states[3]
    assert coin == ["appears", *["moves"] * 8]
    assert disc == ["appears", *["rests"] * 8]
    assert plate == ["appears", *["rests"] * 3, "leaves"]


def test_fingers_on_a_panel_that_blurs_are_found_within_half_a_cell() -> None:
    for result in list(load("capacitive").stream(seed=4))[:6]:
        score = score_objects(result.frame, result["aligned"].contacts, gate_cm=0.5)
        assert score.count_right
        assert score.n_missed == 0
        assert score.worst_error_cm < 0.24


def test_on_a_real_panel_every_contact_is_found_and_alignment_halves_the_centre_error() -> None:
    """The alignment was fitted on recordings 0000, 0008, …; measured here on the others."""
    if not CAPCONTACT.is_dir():
        pytest.skip("the CapContact recordings are not here")
    errors: dict[str, list[float]] = {"plain": [], "aligned": []}
    pipeline = load("capacitive").with_settings(
        {
            "aligned.matrix": ((1.0077, 0.0258), (0.0036, 1.0222)),
            "aligned.shift_cm": (-0.2703, -0.3339),
        }
    )
    for path in sorted(CAPCONTACT.glob("*.npz"))[1::2]:
        for result in pipeline.with_source("recording", path=str(path)).stream(
            only=("aligned", "contacts")
        ):
            for name, found in (("plain", result["contacts"]), ("aligned", result["aligned"])):
                score = score_objects(result.frame, found.contacts, gate_cm=1.0)
                assert score.count_right
                assert score.n_missed == 0
                errors[name] += [e / 0.4775 for _, _, e in score.pairs]
    assert np.median(errors["aligned"]) < 0.25
    assert np.median(errors["aligned"]) < 0.6 * np.median(errors["plain"])
