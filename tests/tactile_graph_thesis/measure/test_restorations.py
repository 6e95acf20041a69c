"""Figures 5.10 to 5.14 and table 5.2 made anew."""

from __future__ import annotations

from io import BytesIO

import numpy as np
import pytest

from tactile_graph import load
from tactile_graph_thesis.drawing.line_fields import (
    draw_5_8,
    draw_5_10_to_5_13,
    draw_5_13,
    draw_5_14,
)
from tactile_graph_thesis.measure.restorations import (
    ENCLOSED,
    EVERY_LINE,
    HEURISTIC,
    LEAST_ENERGY,
    LOGARITHMIC,
    MOVED_IN,
    WAYS,
    RadiusRow,
    figures_5_10_to_5_13,
    frames,
    hulls,
    table_5_2,
)
from tactile_graph_thesis.measure.simulated_rectangle import figure_5_8

pytestmark = pytest.mark.usefixtures("warm_kernels")


@pytest.mark.slow  # much is compiled
def test_the_pictures_hold_every_panel_with_axes_and_legend() -> None:
    raw, ours = figures_5_10_to_5_13(seed=1), figures_5_10_to_5_13(seed=1, way="bayes")
    assert [one.name for one in raw] == ["Disc I", "Disc II", "RECTANGLE II"]
    assert ({one.unit for one in raw}, {one.outlines for one in raw}) == ({"V"}, {()})
    assert {one.unit for one in ours} == {"log reading (asinh)"}
    for figure, panels, labels in (
        (draw_5_8(figure_5_8(0, "restore")), 5, {"line that is on", "true outline"}),
        (
            draw_5_10_to_5_13([raw[0], ours[0]]),
            8,
            {"line that is on", "closed contour", "true outline"},
        ),
        (draw_5_13(raw, ours), 6, {"line that is on", "true outline"}),
        (
            draw_5_14(hulls(seed=1)),
            2,
            {"line that is on", "hull of every line", "hull of what lines enclose",
             "hull of circle-3", "true outline"},
        ),
    ):  # fmt: skip
        drawn = [ax for ax in figure.axes if ax.get_title()]
        assert len(drawn) == panels
        assert drawn[-1].get_xlabel() == "x (cm)"
        (legend,) = figure.legends
        assert {text.get_text() for text in legend.get_texts()} == labels
    file = BytesIO()
    figure.savefig(file, dpi=30)
    assert file.tell() > 1000


@pytest.mark.slow
def test_readings_are_restored_as_the_pipelines_do_it() -> None:
    (raw, *_), (ours, *_) = (figures_5_10_to_5_13(2, way=way) for way in ("thesis", "bayes"))
    (frame,) = frames(2, 1, "thesis")
    np.testing.assert_array_equal(raw.observed.values, frame.image.values)
    restored = load("thesis-lines").runner(seed=2)(frame)["restored"]
    np.testing.assert_array_equal(raw.lined.values, restored.image.values)
    np.testing.assert_array_equal(raw.lines.vertical, restored.lines.vertical)
    closed = load("bayes-lines").runner(["closed"], 2)(frame)["closed"]
    np.testing.assert_array_equal(ours.lines.vertical, closed.vertical)


@pytest.mark.slow
def test_hulls_in_volts_are_like_circle_3s_and_those_on_the_logarithm_are_larger() -> None:
    made = hulls(seed=6, readings=12)
    assert {one.name for one in made} == {"Disc I", "Disc II"}
    ratios = {
        which: np.median([getattr(h, which).area_cm2 / h.heuristic.area_cm2 for h in made])
        for which in ("every_line", "enclosed", "logarithmic")
    }
    assert 0.85 < ratios["enclosed"] < 1.15
    assert ratios["logarithmic"] > 1.15
    assert ratios["every_line"] > ratios["enclosed"]


@pytest.mark.slow
def test_table_5_2_has_radii_by_every_way() -> None:
    rows = table_5_2(seed=5, readings=25)
    assert [(r.name, r.actual_cm) for r in rows] == [("Disc I", 6.9), ("Disc II", 7.7)]
    for row in rows:
        assert tuple(row.radius_cm) == WAYS
        mean = {way: row.mean_cm(way) for way in WAYS}
        assert mean[MOVED_IN] == pytest.approx(row.actual_cm, abs=0.15)
        assert mean[LOGARITHMIC] == pytest.approx(row.actual_cm + 0.5, abs=0.2)
        assert mean[ENCLOSED] == pytest.approx(row.actual_cm - 0.1, abs=0.3)
        assert mean[LEAST_ENERGY] == pytest.approx(row.actual_cm - 0.2, abs=0.3)
        assert mean[EVERY_LINE] > row.actual_cm + 0.5
        assert mean[HEURISTIC] < row.actual_cm
    again = table_5_2(seed=5, readings=25)
    for way in WAYS:
        np.testing.assert_array_equal(again[0].radius_cm[way], rows[0].radius_cm[way])


@pytest.mark.slow
def test_the_radii_are_those_of_the_pipelines() -> None:
    (disc, _) = table_5_2(seed=3, readings=1)
    frame = next(iter(frames(3, 3, "thesis")))
    for way, name in (
        (EVERY_LINE, "thesis-circle"),
        (ENCLOSED, "circle-enclosed"),
        (LOGARITHMIC, "circle-logarithmic"),
        (MOVED_IN, "bayes-circle"),
        (HEURISTIC, "circle-3"),
    ):
        found = load(name).runner(seed=3)(frame)["circle"].radius_cm
        assert disc.radius_cm[way].tolist() == [pytest.approx(found, abs=1e-9)], way


def test_a_reading_without_an_answer_counts_for_nothing() -> None:
    row = RadiusRow("disc", 7.0, {"way": np.array([6.0, np.nan, 7.0])})
    assert (row.mean_cm("way"), row.sd_cm("way")) == (6.5, 0.5)
    np.testing.assert_array_equal(row.error_cm("way"), [1.0, np.nan, 0.0])
