"""The images of figures 4.30 to 4.36."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from tactile_graph import Frame, load
from tactile_graph_filters.morphology.erode import Erode
from tactile_graph_thesis.items.chapter_4.figures_4_29_to_4_36_rounding import (
    Rounding,
    dilated_first,
    whole_and_fine,
)
from tactile_graph_thesis.measure.shown_reading import setting, stages, true_shape


@cache
def frame() -> Frame:
    source = load("rectangle-2").with_source("simulate", scene="rectangle-2", frames=1)
    return next(iter(source.frames(3)))


@cache
def roundings() -> tuple[Rounding, Rounding]:
    return whole_and_fine(frame())


def test_the_frame_is_of_rectangle_ii() -> None:
    true = true_shape(frame())
    assert (true.length_cm, true.breadth_cm) == (14.0, 3.0)


@pytest.mark.slow
def test_fine_cells_are_those_of_the_pipeline_and_whole_ones_the_footprint() -> None:
    whole, fine = roundings()
    nodes = stages("rectangle-2", frame())
    np.testing.assert_array_equal(whole.original.values, nodes["footprint"].values)
    np.testing.assert_array_equal(fine.rounded.values, nodes["rotated"].values)
    assert whole.original.pitch_cm[0] == pytest.approx(10 * fine.original.pitch_cm[0])
    assert whole.rounded.pitch_cm == whole.original.pitch_cm


@pytest.mark.slow
def test_the_pre_filters_pair_is_as_many_passes_as_the_pipeline_makes() -> None:
    nodes, passes = stages("rectangle-2", frame()), setting("rectangle-2", "filled", "times")
    assert passes == 8
    dilated = dilated_first(nodes["rotated"])
    eroded = dilated
    for _ in range(passes):
        eroded = Erode(element="cross3")(eroded)
    trimmed = eroded.values[passes:-passes, passes:-passes]
    np.testing.assert_array_equal(trimmed, nodes["filled"].values)
    assert dilated.origin_cm[0] == pytest.approx(nodes["filled"].origin_cm[0] - passes * 0.13)


def test_rounding_leaves_voids_that_are_gone_after_the_pre_filter() -> None:
    whole, fine = roundings()
    assert 0.0 < fine.lost_share < 1.0
    assert fine.rounded.count == round((1.0 - fine.lost_share) * fine.original.count)
    assert whole.lost_share > 0.0
    assert stages("rectangle-2", frame())["filled"].count > fine.original.count


@pytest.mark.parametrize("which", [0, 1], ids=["whole", "fine"])
def test_where_the_mean_is_subtracted_the_centre_is_the_origin_and_turning_keeps_it(
    which: int,
) -> None:
    found = roundings()[which]
    centred, turned = found.centred.xy_cm, found.turned.xy_cm
    assert np.abs(centred.mean(axis=0)).max() < 0.5
    assert np.hypot(*turned.T) == pytest.approx(np.hypot(*centred.T))
    assert np.ptp(turned[:, 0]) > np.ptp(turned[:, 1])
    columns = np.nonzero(found.rounded.values)[1]
    centre = found.rounded.origin_cm[0] + (columns.mean() + 0.5) * found.rounded.pitch_cm[0]
    assert abs(centre) < 0.6
