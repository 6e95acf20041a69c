"""Figures 5.8 to 5.14 and table 5.2 made anew."""

from __future__ import annotations

from io import BytesIO

import numpy as np
import pytest

from tactile_graph.wires import Circle
from tactile_graph_thesis.drawing.line_fields import draw_5_8, draw_5_10_to_5_13, draw_5_14
from tactile_graph_thesis.measure.restorations import (
    RECTANGLE,
    Restoration,
    figure_5_8,
    figure_5_14,
    figures_5_10_to_5_13,
    table_5_2,
)


def rms(made: Restoration, which: str) -> float:
    assert made.truth is not None
    return float(np.sqrt(np.mean((getattr(made, which).values - made.truth.values) ** 2)))


@pytest.mark.parametrize("seed", range(3))
def test_the_line_field_is_exactly_the_rectangle_as_the_thesis_says(seed: int) -> None:
    made = figure_5_8(seed, "restore")
    on = np.zeros((16, 16), bool)
    on[RECTANGLE] = True
    np.testing.assert_array_equal(made.lines.horizontal, on[:-1] ^ on[1:])
    np.testing.assert_array_equal(made.lines.vertical, on[:, :-1] ^ on[:, 1:])


def test_without_lines_the_image_is_blurred_and_with_them_it_is_not() -> None:
    made = figure_5_8(1)
    assert rms(made, "lined") < 0.6 * rms(made, "observed")
    assert rms(made, "smooth") > 1.5 * rms(made, "lined")


def test_the_quick_restorer_ends_lower_than_the_sampler_and_both_see_the_same() -> None:
    sampled, quick = figure_5_8(2), figure_5_8(2, "restore")
    np.testing.assert_array_equal(sampled.observed.values, quick.observed.values)
    assert quick.energy < sampled.energy


def test_the_pictures_hold_every_panel_with_axes_and_legend() -> None:
    objects = figures_5_10_to_5_13(seed=1)
    assert [one.name for one in objects] == ["Disc I", "Disc II", "RECTANGLE II"]
    for figure, panels, labels in (
        (draw_5_8(figure_5_8(0, "restore")), 5, {"line that is on", "true outline"}),
        (
            draw_5_10_to_5_13(objects),
            12,
            {"line that is on", "closed contour", "true outline"},
        ),
        (
            draw_5_14(figure_5_14(seed=1)),
            2,
            {"line that is on", "hull of the line field", "hull of circle-3", "true outline"},
        ),
    ):
        drawn = [ax for ax in figure.axes if ax.get_title()]
        assert len(drawn) == panels
        assert drawn[-1].get_xlabel() == "x (cm)"
        (legend,) = figure.legends
        assert {text.get_text() for text in legend.get_texts()} == labels
    file = BytesIO()
    figure.savefig(file, dpi=30)
    assert file.tell() > 1000


def test_the_hull_of_the_lines_holds_the_true_disc_where_the_opened_one_cuts_into_it() -> None:
    for one in figure_5_14(seed=1):
        assert isinstance(one.shape, Circle)
        assert one.bayesian.area_cm2 > one.heuristic.area_cm2
        assert 0.95 < one.bayesian.area_cm2 / one.shape.area_cm2 < 1.25


def test_table_5_2_has_radii_by_every_way() -> None:
    rows = table_5_2(seed=5, readings=6)
    assert [(r.name, r.actual_cm) for r in rows] == [("Disc I", 6.9), ("Disc II", 7.7)]
    for row in rows:
        assert row.bayesian_cm[0] == pytest.approx(row.actual_cm, abs=0.2)
        assert row.line_hull_cm[0] > row.bayesian_cm[0]
        assert row.volt_hull_cm[0] < row.line_hull_cm[0]
        assert row.heuristic_cm[0] < row.bayesian_cm[0]
    again = table_5_2(seed=5, readings=6)
    assert again[0].bayesian_cm == pytest.approx(rows[0].bayesian_cm, abs=1e-9)
