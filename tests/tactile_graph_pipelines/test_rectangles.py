"""The rectangular algorithms on simulated pads: how far off, and what odd scenes come to."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from tactile_graph import Frame, Rectangle, load
from tactile_graph.engine.outcomes.outcome import Failed, Skipped
from tactile_graph.wires import Mask
from tactile_graph_filters.morphology.close import Close
from tactile_graph_filters.morphology.subdivide import subdivide
from tactile_graph_fitters.orientation.orientation import Orientation
from tactile_graph_fitters.orientation.rotate_mask import rotate_mask
from tactile_graph_thesis.measure.rectangles import (
    OBJECTS,
    STATED_CELL_CM,
    rectangle_frames,
    signed_errors,
)

pytestmark = pytest.mark.usefixtures("warm_kernels")

ORIGIN_CM = (-0.15, -0.15)
EVERY = ("rectangle-1", "rectangle-2", "rectangle-3", "ellipse-direct")


def errors(name: str, n: int, seed: int, **pad: object) -> NDArray[np.float64]:
    """Angle (degrees), length and breadth errors on table 4.6's rectangles, shape (answers, 3)."""
    pipeline = load(name).with_source("simulate", scene="rectangles", frames=n, **pad)
    rows = []
    for result in pipeline.stream(seed=seed):
        found = result.get("rectangle")
        assert result.frame.truth is not None
        true = result.frame.truth[0].shape
        assert isinstance(true, Rectangle)
        if found is not None:
            off = abs(math.remainder(found.angle_rad - true.angle_rad, math.pi))
            rows.append(
                (
                    math.degrees(off),
                    abs(found.length_cm - true.length_cm),
                    abs(found.breadth_cm - true.breadth_cm),
                )
            )
    return np.array(rows)


@pytest.mark.slow  # takes seconds
def test_rectangle_3_errs_by_at_most_half_of_rectangle_2_in_every_column() -> None:
    second, third = (errors(name, 160, seed=1) for name in ("rectangle-2", "rectangle-3"))
    assert len(third) == 160
    assert (third.mean(axis=0) <= 0.5 * second.mean(axis=0)).all()


@pytest.mark.slow
def test_rectangle_3_finds_the_angle_within_a_degree_and_the_sides_within_0_4_cm() -> None:
    found = errors("rectangle-3", 160, seed=1).mean(axis=0)
    assert found[0] < 1.0
    assert found[1:].max() < 0.4


@pytest.mark.slow
def test_read_at_1_cm_a_cell_the_second_evolution_errs_less_than_the_first_as_in_the_thesis() -> (
    None
):
    frames = rectangle_frames(150, seed=1)
    first, second = (
        signed_errors(load(name).runner(), frames, STATED_CELL_CM)
        for name in ("rectangle-1", "rectangle-2")
    )
    for name in OBJECTS:
        before, after = (np.nanmean(np.abs(e[name]), axis=0) for e in (first, second))
        assert (after[1:3] < before[1:3]).all()
        assert after[0] == pytest.approx(before[0], rel=0.1)


@pytest.mark.slow
def test_the_pre_filter_of_rectangle_2_fills_a_lost_element_which_one_pass_does_not() -> None:
    cells = {(r, c) for r in range(5, 11) for c in range(3, 13)} - {(7, 6)}
    frame = touched(*cells)
    whole = load("rectangle-2").run(touched(*cells, (7, 6)))["rectangle"]
    for times, fills in ((8, True), (1, False)):
        pipeline = load("rectangle-2").with_settings({"filled.times": times})
        found = pipeline.run(frame)["rectangle"]
        same = abs(found.length_cm - whole.length_cm) < 0.1
        assert same == fills


@pytest.mark.parametrize(("angle", "enough"), [(0.0, 5), (0.3, 6), (math.pi / 4, 8)])
def test_eight_passes_fill_a_lost_element_at_any_angle(angle: float, enough: int) -> None:
    values = np.ones((9, 9), np.bool_)
    values[4, 4] = False
    fine = subdivide(Mask(values, (1.3, 1.3), ORIGIN_CM), factor=10)
    axis = Orientation(angle, 5.7, 5.7, 0.5, 0.1, False)
    rotated = rotate_mask(fine, axis)
    row, column = (int((5.7 - rotated.origin_cm[k]) / 0.13) for k in (1, 0))
    around = slice(row - 20, row + 21), slice(column - 20, column + 21)
    assert Close(times=enough)(rotated).values[around].all()
    assert not Close(times=4)(rotated).values[around].all()
    assert enough <= 8


@pytest.mark.slow
def test_on_an_even_pad_corrected_sides_are_nearer_than_the_full_axes() -> None:
    source = load("rectangle-1").with_source(
        "simulate", scene="rectangle-1", frames=60, sigma=0.0, voids=0.0
    )
    full, corrected = [], []
    for result in source.stream(seed=2):
        found = result["rectangle"]
        full.append((abs(found.length_cm - 16.0), abs(found.breadth_cm - 7.0)))
        corrected.append(
            (abs(found.corrected_length_cm - 16.0), abs(found.corrected_breadth_cm - 7.0))
        )
    assert (np.mean(corrected, axis=0) < 0.7 * np.mean(full, axis=0)).all()


def pad(values: NDArray[np.float64]) -> Frame:
    return Frame.of(values, 1.3, ORIGIN_CM, "volt")


def touched(*cells: tuple[int, int]) -> Frame:
    values = np.zeros((16, 16))
    for cell in cells:
        values[cell] = 0.1
    return pad(values)


@pytest.mark.parametrize("name", EVERY)
def test_an_empty_pad_is_skipped_with_the_reason_and_nothing_after_the_footprint_runs(
    name: str,
) -> None:
    result = load(name).run(touched())
    outcome = result.outcome("rectangle")
    assert isinstance(outcome, Skipped)
    assert "footprint.count = 0" in outcome.reason
    assert [n for n, t in result.times_us.items() if t > 0] == ["footprint"]
    assert not result.failures


@pytest.mark.parametrize("name", EVERY)
def test_a_full_pad_is_skipped_for_no_outline_is_on_it(name: str) -> None:
    outcome = load(name).run(pad(np.full((16, 16), 0.1))).outcome("rectangle")
    assert isinstance(outcome, Skipped)
    assert "footprint.fraction = 1" in outcome.reason


@pytest.mark.parametrize("name", EVERY)
def test_lone_cells_vanish_in_the_comparison_and_that_is_the_reason(name: str) -> None:
    outcome = load(name).run(touched((3, 3), (12, 9))).outcome("rectangle")
    assert isinstance(outcome, Skipped)
    assert "clean.count = 0" in outcome.reason


def test_a_footprint_too_narrow_for_the_opening_vanishes_and_says_so() -> None:
    outcome = load("rectangle-2").run(touched(*[(r, c) for r in (7, 8) for c in range(3, 12)]))
    skipped = outcome.outcome("rectangle")
    assert isinstance(skipped, Skipped)
    assert "opened.count = 0" in skipped.reason


@pytest.mark.slow  # each is compiled
@pytest.mark.parametrize("name", EVERY)
def test_a_frame_full_of_nan_fails_in_words_and_the_run_goes_on(name: str) -> None:
    good = next(iter(load(name).frames()))
    first, second = load(name).stream([pad(np.full((16, 16), np.nan)), good])
    outcome = first.outcome("rectangle")
    assert isinstance(outcome, Failed)
    assert outcome.origin in ("footprint", "siemens")
    assert "valid" in outcome.reason
    assert second.ok


@pytest.mark.slow
@pytest.mark.parametrize("name", ["rectangle-1", "rectangle-2", "rectangle-3"])
def test_every_rectangle_is_in_pad_coordinates_whatever_was_done_to_the_image(name: str) -> None:
    source = load(name).with_source("simulate", scene="rectangle-1", frames=1, sigma=0.0, voids=0.0)
    frame = next(iter(source.frames(4)))
    shifted = Frame.of(frame.image.values, 1.3, (99.85, 49.85), "volt")
    here, there = (load(name).run(f)["rectangle"] for f in (frame, shifted))
    assert there.x_cm == pytest.approx(here.x_cm + 100, abs=1e-6)
    assert there.y_cm == pytest.approx(here.y_cm + 50, abs=1e-6)
    assert there.length_cm == pytest.approx(here.length_cm, abs=1e-6)
    assert there.angle_rad == pytest.approx(here.angle_rad, abs=1e-6)


@pytest.mark.slow  # four fits are compiled
def test_the_direct_ellipses_agree_with_each_other_on_an_even_pad() -> None:
    source = load("ellipse-direct").with_source(
        "simulate", scene="rectangle-1", frames=5, sigma=0.0, voids=0.0
    )
    for result in source.stream(seed=1):
        swept, direct, geometric = (result[n] for n in ("swept", "direct", "geometric"))
        for other in (direct, geometric):
            off = abs(math.remainder(other.angle_rad - swept.angle_rad, math.pi))
            assert math.degrees(off) < 3.0
            assert other.semi_major_cm == pytest.approx(swept.semi_major_cm, rel=0.1)


def test_each_rectangle_evolves_from_the_one_before() -> None:
    lineage = [load(f"rectangle-{n}").evolves for n in (1, 2, 3)]
    assert lineage == ["", "rectangle-1", "rectangle-2"]
