"""The Bayesian pipelines on simulated pads: no threshold, no unit, and how far off they are."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tactile_graph import Circle, Frame, Rectangle, load
from tactile_graph.engine.outcomes.outcome import Failed, Skipped
from tactile_graph_tracking.score_objects import score_objects

pytestmark = pytest.mark.usefixtures("warm_kernels")

EVERY = ("bayes-smooth", "bayes-lines", "bayes-circle", "bayes-rectangle", "bayes-objects")


def frames(scene: str, n: int, seed: int, **pad: object) -> list[Frame]:
    source = load("bayes-circle").with_source("simulate", scene=scene, frames=n, **pad)
    return list(source.frames(seed=seed))


def off(found: Circle, frame: Frame) -> tuple[float, float]:
    assert frame.truth is not None
    true = frame.truth[0].shape
    assert isinstance(true, Circle)
    centre = math.hypot(found.x_cm - true.x_cm, found.y_cm - true.y_cm)
    return centre, abs(found.radius_cm - true.radius_cm)


@pytest.mark.parametrize("name", EVERY)
def test_no_threshold_and_no_level_in_volts_is_anywhere(name: str) -> None:
    text = load(name).text
    assert "threshold," not in text
    assert "_v:" not in text


@pytest.mark.slow  # much is compiled
def test_bayes_circle_is_nearer_than_circle_3_on_the_same_frames() -> None:
    ours, threshold = load("bayes-circle").runner(), load("circle-3").runner()
    rows = []
    for frame in frames("discs", 45, seed=11):
        mine, other = ours(frame)["circle"], threshold(frame)["circle"]
        rows.append((*off(mine, frame), *off(other, frame)))
    centre, radius, centre_3, radius_3 = np.mean(rows, axis=0)
    assert centre < 0.20
    assert radius < 0.12
    assert centre < 0.6 * centre_3
    assert radius < 0.6 * radius_3


@pytest.mark.slow  # all kinds of moves are compiled
def test_a_reading_in_another_unit_gives_the_same_circle() -> None:
    (frame,) = frames("discs", 1, seed=3)
    run = load("bayes-circle").runner()
    image = frame.image
    in_millivolt = Frame.of(1000.0 * image.values, image.pitch_cm, image.origin_cm, "raw")
    one, other = run(frame)["circle"], run(in_millivolt)["circle"]
    assert (one.x_cm, one.y_cm, one.radius_cm) == pytest.approx(
        (other.x_cm, other.y_cm, other.radius_cm), abs=1e-6
    )


@pytest.mark.slow
def test_bayes_rectangle_finds_angle_and_sides() -> None:
    run = load("bayes-rectangle").runner()
    rows = []
    for frame in frames("rectangles", 30, seed=5):
        found = run(frame)["rectangle"]
        assert frame.truth is not None
        true = frame.truth[0].shape
        assert isinstance(true, Rectangle)
        turn = math.degrees(abs(math.remainder(found.angle_rad - true.angle_rad, math.pi)))
        sides = abs(found.length_cm - true.length_cm), abs(found.breadth_cm - true.breadth_cm)
        rows.append((turn, *sides))
    angle, length, breadth = np.mean(rows, axis=0)
    assert angle < 2.0
    assert length < 0.5
    assert breadth < 0.3


@pytest.mark.slow
def test_bayes_objects_counts_and_places_several() -> None:
    run = load("bayes-objects").runner()
    right = 0
    errors: list[float] = []
    for frame in frames("six", 12, seed=4):
        result = run(frame)
        right += result["objects"].count == 6
        errors += [e for _, _, e in score_objects(frame, result["shapes"]).pairs]
    assert right >= 10
    assert len(errors) >= 66
    assert np.mean(errors) < 0.4


@pytest.mark.parametrize("name", EVERY)
def test_an_empty_pad_is_not_swept(name: str) -> None:
    pipeline = load(name)
    noise = frames("empty", 3, seed=1)
    still = Frame.of(np.zeros((16, 16)), 1.3, (-0.15, -0.15), "volt")
    for frame in (*noise, still):
        result = pipeline.run(frame)
        outcome = result.outcome(next(iter(pipeline.outputs)))
        assert isinstance(outcome, Skipped), frame
        assert "stands_out" in outcome.reason
        assert not result.failures


@pytest.mark.slow
@pytest.mark.parametrize("name", EVERY)
def test_odd_images_come_to_an_answer_or_a_reason(name: str) -> None:
    pipeline = load(name)
    one, full, line = np.zeros((16, 16)), np.ones((16, 16)), np.zeros((16, 16))
    one[7, 7] = 0.5
    line[4, 2:12] = 0.5
    lost = np.zeros((16, 16))
    lost[4:12, 4:12] = 0.4
    lost[6, 6] = np.nan
    for values in (one, full, line, lost):
        result = pipeline.run(Frame.of(values, 1.3, (-0.15, -0.15), "volt"))
        for output in pipeline.outputs:
            outcome = result.outcome(output)
            if isinstance(outcome, Failed):
                assert type(outcome.error).__name__ == "Degenerate", outcome


@pytest.mark.slow
def test_a_lost_element_within_is_bridged_and_the_circle_stays_whole() -> None:
    (frame,) = frames("disc-1", 1, seed=2, sigma=0.0, voids=0.0)
    whole = load("bayes-circle").run(frame)
    values = frame.image.values.copy()
    x, y = frame.truth[0].shape.x_cm, frame.truth[0].shape.y_cm  # type: ignore[index]
    i, j = int((y + 0.15) / 1.3), int((x + 0.15) / 1.3)
    values[i, j] = values[i, j + 1] = 0.0
    image = frame.image
    torn = Frame.of(values, image.pitch_cm, image.origin_cm, "volt")
    result = load("bayes-circle").runner(["object", "circle"])(torn)
    assert result["object"].mask.values[i, j]
    assert result["object"].mask.values[i, j + 1]
    assert result["circle"].radius_cm == pytest.approx(whole["circle"].radius_cm, abs=0.05)


@pytest.mark.parametrize("shape", [(1, 16), (16, 1)])
def test_a_single_row_of_cells_has_no_circle(shape: tuple[int, int]) -> None:
    values = np.zeros(shape)
    values.flat[5:11] = 2.0
    outcome = load("bayes-circle").run(Frame.of(values, 1.0, quantity="volt")).outcomes["circle"]
    assert "frame.image.rows > 1 and frame.image.columns > 1" in str(outcome)
