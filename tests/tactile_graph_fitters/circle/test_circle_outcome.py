"""Degenerate input is one typed outcome, in words, for every circle fit."""

import numpy as np
import pytest

from helpers_circles import ALL_FITS, arc, arc_xy, three
from tactile_graph import Frame, load
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Circle, Points
from tactile_graph_fitters.circle.circle_outcome import hardly_bends
from tactile_graph_fitters.circle.fit_circle import fit_circle
from tactile_graph_fitters.circle.fit_circle_thesis import fit_circle_thesis

third = np.arange(10)[:, None] / 10.0 * (1.0, 3.0)  # in one line but for rounding
HOPELESS = {
    "none": (np.empty((0, 2)), "0 points: a circle needs at least 3"),
    "one": (np.ones((1, 2)), "1 point: a circle needs at least 3"),
    "two": (np.eye(2), "2 points: a circle needs at least 3"),
    "two places": (np.eye(2)[[0, 1, 1, 0]], "4 points at 2 places: a circle needs at least 3"),
    "all equal": (np.full((5, 2), 3.3), "5 points, all at one place"),
    "all zero": (np.zeros((3, 2)), "3 points, all at one place"),
    "on a line": (np.array([[0.0, 0], [1, 1], [2, 2]]), "3 points on one line: no circle fits"),
    "upright line": (np.array([[1.5, 0], [1.5, 1], [1.5, 5]]), "3 points on one line"),
    "rounded line": (third, "10 points on one line"),
    "far rounded line": (third + 1e7, "10 points on one line"),
    "tiny line": (third * 1e-305, "10 points on one line"),
    "nan": (np.array([[0.0, 0], [1, np.nan], [2, 2], [1, 0]]), "1 of 4 points not finite"),
    "infinite": (np.array([[0.0, -np.inf], [np.inf, 1], [2, 2]]), "2 of 3 points not finite"),
    "only nan": (np.full((4, 2), np.nan), "4 of 4 points not finite"),
}


@pytest.mark.parametrize("fit", ALL_FITS)
@pytest.mark.parametrize("case", HOPELESS)
def test_hopeless_points_are_degenerate_in_words(fit, case):
    xy, words = HOPELESS[case]
    with pytest.raises(Degenerate, match=words):
        fit(Points(xy.astype(float)))


@pytest.mark.parametrize("fit", ALL_FITS)
@pytest.mark.parametrize("size", [1e-320, 5e-308, 1e-200, 1e-9, 1e9, 1e200, 1e307])
def test_sizes_up_to_the_edge_of_numbers_work(fit, size):
    xy = arc_xy(Circle(2.0, 3.0, 1.0), 360, 24)
    got = fit(Points(xy * size))
    rounding = max(1e-7, 5e-324 / size)
    assert three(got) / size == pytest.approx([2.0, 3.0, 1.0], rel=20 * rounding)
    assert got.rms_cm / size <= 20 * rounding


def test_circle_beyond_all_numbers_is_degenerate():
    xy = (arc_xy(Circle(-1.0, 0.0, 1.0), 2, 24)) * 1e308
    with pytest.raises(Degenerate, match="24 points: their circle is too large for a number"):
        fit_circle(Points(xy * 10.0))  # the points are numbers, the radius 1e309 is not


def test_arc_too_short_for_the_thesis_iteration_is_degenerate():
    points = arc(Circle(0.0, 0.0, 100.0), 60, 30)
    with pytest.raises(Degenerate, match="30 points: no circle found within 1000 iterations"):
        fit_circle_thesis(points)


@pytest.mark.parametrize("fit", ALL_FITS)
def test_points_of_other_memory_layouts_are_taken(fit):
    xy = arc_xy(Circle(2.0, 3.0, 1.0), 360, 24)
    assert fit(Points(np.asfortranarray(xy))) == fit(Points(xy.copy()))
    swapped = fit(Points(xy[::-1, ::-1]))
    assert three(swapped) == pytest.approx([3.0, 2.0, 1.0], abs=1e-7)
    assert fit(Points(xy.astype(np.float32))).radius_cm == pytest.approx(1.0, abs=1e-6)


def bar(degrees: float) -> Points:
    """Return the outline of a bar of 20 by 4 cm, turned."""
    along = np.linspace(-10.0, 10.0, 11)
    sides = [np.stack([along, np.full(11, y)], axis=1) for y in (-2.0, 2.0)]
    outline = np.concatenate([*sides, [[10.3, 0.6]]])
    turn = np.radians(degrees)
    turned = [[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]]
    return Points(outline @ np.array(turned) + 5.0)


@pytest.mark.parametrize("degrees", [0, 40, 90, 200])
def test_a_circle_through_points_of_a_bar_says_that_they_hardly_bend(degrees):
    fit = fit_circle(bar(degrees))
    assert fit.radius_cm > 100.0
    assert "they lie 2 cm off it: these are no points of a disc" in hardly_bends(bar(degrees), fit)


@pytest.mark.parametrize("degrees", [120, 180, 360])
@pytest.mark.parametrize("fit", ALL_FITS)
def test_nothing_is_said_of_an_arc_that_bends_by_more_than_it_scatters(fit, degrees):
    noise = 0.01 * np.random.default_rng(0).standard_normal((40, 2))
    disc = Circle(3.0, -7.0, 5.0)
    points = Points(arc_xy(disc, degrees, 40) + noise)
    assert fit.notice(points, fit(points)) == ""


@pytest.mark.slow
def test_a_pipeline_tells_of_the_bar_it_took_for_a_disc():
    values = np.zeros((16, 16))
    values[np.abs(np.subtract.outer(np.arange(16), 0.5 * np.arange(16)) - 3.0) < 1.8] = 1.0
    result = load("circle-1").run(Frame.of(values, 1.3, quantity="volt"))
    assert result["circle"].radius_cm > 20.8
    assert "these are no points of a disc" in result.notices["circle"]
