"""The images of figures 4.24 to 4.36."""

import numpy as np
import pytest

from tactile_graph import load
from tactile_graph.wires import Mask, Points
from tactile_graph_filters.morphology.erode import Erode
from tactile_graph_thesis.measure.rectangle_stages import PASSES, rectangle_frame, rectangle_stages

FIGURES = ("4.24", "4.25", "4.26", "4.27", "4.28", "4.30", "4.31", "4.32", "4.33", "4.34", "4.35",
           "4.36")  # fmt: skip


@pytest.fixture(scope="module")
def stages():
    return rectangle_stages(rectangle_frame(3))


def test_every_figure_but_the_block_diagram_has_its_images(stages):
    assert tuple(stages) == FIGURES
    sizes = {figure: len(images) for figure, images in stages.items() if len(images) > 1}
    assert sizes == {"4.30": 4, "4.31": 4, "4.33": 2, "4.35": 2}


def test_the_frame_is_of_rectangle_ii():
    true = rectangle_frame(3).truth[0].shape
    assert (true.length_cm, true.breadth_cm) == (14.0, 3.0)


def test_images_are_those_of_the_pipelines(stages):
    result = load("rectangle-2").run(rectangle_frame(3))
    for figure, n, node in (("4.24", 0, "footprint"), ("4.33", 1, "filled"), ("4.35", 1, "opened")):
        assert np.array_equal(stages[figure][n].shown.values, result[node].values)
    assert np.array_equal(stages["4.36"][0].shown.xy_cm, result["boundary"].xy_cm)


def test_the_pre_filters_pair_is_as_many_passes_as_the_pipeline_makes(stages):
    dilated, filled = (stage.shown for stage in stages["4.33"])
    eroded = dilated
    for _ in range(PASSES):
        eroded = Erode(element="cross3")(eroded)
    trimmed = eroded.values[PASSES:-PASSES, PASSES:-PASSES]
    assert np.array_equal(trimmed, filled.values)
    assert dilated.origin_cm[0] == pytest.approx(filled.origin_cm[0] - PASSES * 0.13)


def test_rounding_leaves_voids_that_are_gone_after_the_pre_filter(stages):
    original, rounded = stages["4.31"][0].shown, stages["4.31"][3].shown
    assert rounded.count < original.count
    assert stages["4.33"][1].shown.count > original.count


@pytest.mark.parametrize("figure", ["4.30", "4.31"])
def test_where_the_mean_is_subtracted_the_centre_is_the_origin_and_turning_keeps_it(stages, figure):
    _, less, turned, rounded = (stage.shown for stage in stages[figure])
    assert isinstance(less, Points)
    assert np.abs(less.xy_cm.mean(axis=0)).max() < 0.5
    assert np.hypot(*turned.xy_cm.T) == pytest.approx(np.hypot(*less.xy_cm.T))
    assert np.ptp(turned.xy_cm[:, 0]) > np.ptp(turned.xy_cm[:, 1])
    assert isinstance(rounded, Mask)
    columns = np.nonzero(rounded.values)[1]
    centre = rounded.origin_cm[0] + (columns.mean() + 0.5) * rounded.pitch_cm[0]
    assert abs(centre) < 0.6
