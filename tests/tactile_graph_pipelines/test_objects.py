"""Several objects by the shipped pipelines: told apart, placed, tracked, on a pad and a panel."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from helpers_panel import Camera, panel_frames, real_panel_frames
from tactile_graph import Frame, load
from tactile_graph.api.result import Result
from tactile_graph.engine.outcomes.outcome import Skipped
from tactile_graph_filters.contacts.align_contacts import AlignContacts
from tactile_graph_tracking.score_objects import ObjectScore, score_objects

pytestmark = pytest.mark.usefixtures("warm_kernels")

# The alignment of the real panel was fitted on recordings 0000, 0008, …; tried on the others.
REAL_CAMERA = ((1.0065, 0.0279), (0.0011, 1.0187)), (-0.2352, -0.2531)
REAL_LOG_AREA = (1.5311, -0.06584, -0.16679, -6e-05, 0.00505, 0.00438)
MADE_CAMERA = Camera(((1.01, 0.02), (-0.01, 0.99)), (-0.24, 0.2), 0.3, -0.02)


def score_of(result: Result) -> ObjectScore:
    return score_objects(result.frame, result["objects"].contacts)


@pytest.mark.slow
def test_six_objects_that_do_not_touch_are_counted_and_placed() -> None:
    pipeline = load("objects").with_source("simulate", scene="six", frames=24)
    scores = [score_of(r) for r in pipeline.stream(seed=1)]
    assert len(scores) == 24
    assert np.mean([s.count_right for s in scores]) >= 0.9
    assert np.mean([s.mean_error_cm for s in scores]) < 0.5
    assert np.mean([s.n_paired for s in scores]) >= 5.8


@pytest.mark.slow
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


@pytest.mark.slow
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


@pytest.mark.slow
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


@pytest.mark.slow
def test_fingers_on_a_panel_that_blurs_are_found_within_half_a_cell() -> None:
    for result in list(load("capacitive").stream(seed=4))[:6]:
        score = score_objects(result.frame, result["aligned"].contacts, gate_cm=0.5)
        assert score.count_right
        assert score.n_missed == 0
        assert score.worst_error_cm < 0.24


@pytest.mark.slow
@pytest.mark.parametrize("real", [True, False], ids=["real", "look-alike"])
def test_on_a_panel_contacts_are_counted_and_their_centres_beat_the_plain_centroid(
    real: bool, tmp_path: Path
) -> None:
    errors: dict[str, list[float]] = {"contacts": [], "sharp": [], "upright": []}
    areas: dict[str, list[float]] = {"sharp": [], "aligned": []}
    matrix, shift_cm = REAL_CAMERA if real else MADE_CAMERA[:2]
    log_area = REAL_LOG_AREA if real else (MADE_CAMERA.of_one, MADE_CAMERA.of_x, 0.0, 0.0, 0.0, 0.0)
    pipeline = load("capacitive").with_settings({"aligned.log_area": log_area})
    run = pipeline.runner(only=("aligned", *errors))
    align = AlignContacts(matrix=matrix, shift_cm=shift_cm)
    made = panel_frames(tmp_path, camera=MADE_CAMERA)
    for frame in real_panel_frames(slice(1, None, 2)) if real else made:
        result = run(frame)
        assert frame.truth is not None
        for name, found_errors in errors.items():
            score = score_objects(frame, align(result[name].contacts).contacts, gate_cm=1.0)
            assert score.count_right
            assert score.n_missed == 0
            found_errors += [e / 0.4775 for _, _, e in score.pairs]
        for name, found_areas in areas.items():
            for i, j, _ in score.pairs:
                ratio = result[name].contacts[j].area_cm2 / frame.truth[i].shape.area_cm2
                found_areas.append(abs(ratio - 1.0))
    plain, sharp, upright = (float(np.median(e)) for e in errors.values())
    assert upright < 0.19
    assert upright < 0.85 * sharp
    assert upright < 0.75 * plain
    as_they_are, by_place = (float(np.median(e)) for e in areas.values())
    assert by_place < 0.13
    assert by_place < 0.9 * as_they_are
