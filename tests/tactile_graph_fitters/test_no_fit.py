"""A kernel that finds no shape says why by its status; every number beside it is 0."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
import pytest

from helpers_ellipses import drawn
from helpers_modes import plainly
from tactile_graph import loads
from tactile_graph.errors import PipelineError
from tactile_graph_fitters.circle import principal_axes as circles
from tactile_graph_fitters.circle.algebraic import HYPER, algebraic_fit
from tactile_graph_fitters.circle.even_load import TOO_FEW, Readings, even_disc
from tactile_graph_fitters.circle.fit_circle_thesis import thesis_fit
from tactile_graph_fitters.circle.geometric import geometric_fit as circle_fit
from tactile_graph_fitters.circle.principal_axes import bounds, into_frame
from tactile_graph_fitters.ellipse import direct_ellipse as ellipses
from tactile_graph_fitters.ellipse.direct_ellipse import direct_fit, direct_shape, ellipse_frame
from tactile_graph_fitters.ellipse.fit_ellipse import geometric_fit as ellipse_fit
from tactile_graph_fitters.ellipse.fit_ellipse_origin import NO_SPREAD, origin_fit, polar
from tactile_graph_fitters.orientation.orientation import mask_scatter, points_scatter
from tactile_graph_fitters.rectangle.fit_rectangle import outline_fit
from tactile_graph_fitters.rectangle.fit_rectangle_load import ONE_LINE, Window, likeliest

LINE = np.column_stack([np.arange(6.0), 2.0 * np.arange(6.0)])
WRONG = {
    circles.TOO_FEW: np.eye(2),
    circles.NOT_FINITE: np.array([[0.0, 1.0], [math.nan, 2.0], [3.0, 3.0], [4.0, 0.0], [1.0, 1.0]]),
    circles.OUT_OF_RANGE: 1e200 * np.array([[0.0, 1.0], [2.0, 5.0], [3.0, 3.0], [4.0, 0.0]]),
    circles.ALL_EQUAL: np.full((5, 2), 3.0),
    circles.ONE_LINE: LINE,
}
"""Points that no shape fits, by what is wrong with them."""
LAW = np.array([0.5, 0.17, 1.8, 1e-3, 1.2, 0.0])


class Fit(NamedTuple):
    """A kernel, and what it takes after the points."""

    kernel: Any
    settings: tuple[float, ...] = ()


FITS = {
    "circle": Fit(circle_fit),
    "algebraic": Fit(algebraic_fit, (HYPER,)),
    "thesis": Fit(thesis_fit, (100, 1e-8)),
    "ellipse": Fit(ellipse_fit),
    "direct": Fit(direct_fit),
    "rectangle": Fit(outline_fit, (0.5, 2, 1e-11)),
}


@pytest.mark.parametrize("name", FITS)
@pytest.mark.parametrize("status", WRONG)
def test_points_that_nothing_fits_give_a_status_and_zeros(name, status):
    kernel, settings = FITS[name]
    found = plainly(kernel)(WRONG[status], *settings)
    assert found == (status, *[0] * (len(found) - 1))


@pytest.mark.parametrize("status", [circles.TOO_FEW, circles.NOT_FINITE, circles.OUT_OF_RANGE])
def test_points_without_bounds_give_the_frame_that_changes_nothing(status):
    assert plainly(bounds)(WRONG[status]) == (status, 0.0, 0.0, 0.0, 0.0)
    found, uv, frame = plainly(into_frame)(WRONG[status])
    assert (found, uv.shape, frame) == (status, (2, 0), (0.0, 0.0, 1.0, 1.0, 0.0))


PARABOLA = np.column_stack([np.arange(-4.0, 5.0), np.arange(-4.0, 5.0) ** 2])
GRID = np.array([[x, y] for x in (0.0, 1.0) for y in (0.0, 1.0, 2.0)])
ROUND = np.linspace(0.0, 2.0 * np.pi, 30, endpoint=False)
FLAT = np.column_stack([np.cos(ROUND), 1e-8 * np.sin(ROUND)])


@pytest.mark.parametrize("status", [ellipses.OTHER_CONIC, ellipses.FEW_PLACES, ellipses.FLAT])
def test_points_of_no_ellipse_give_a_status_and_zeros(status):
    xy = {
        ellipses.OTHER_CONIC: PARABOLA,
        ellipses.FEW_PLACES: np.repeat(GRID[[0, 1, 2, 3]] * [1.0, 1.5], 3, axis=0),
        ellipses.FLAT: FLAT,
    }[status]
    for kernel in (direct_fit, ellipse_fit):
        assert plainly(kernel)(xy) == (status, *[0] * 7)
    if status != ellipses.FEW_PLACES:
        _, uv, _ = plainly(ellipse_frame)(xy)
        assert plainly(direct_shape)(uv) == (status, *[0] * 5)


def test_points_of_a_line_and_one_beside_it_are_on_many_conics():
    uv = np.array([[-2.0, -1.0, 0.0, 1.0, 2.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0, 1.0]])
    uv -= uv.mean(axis=1, keepdims=True)
    assert plainly(direct_shape)(uv) == (ellipses.OTHER_CONIC, *[0] * 5)


def test_nothing_has_no_scatter():
    assert plainly(mask_scatter)(np.zeros((3, 4), bool)) == (0, 0, 0, 0, 0, 0)
    assert plainly(points_scatter)(np.empty((0, 2))) == (0, 0, 0, 0, 0, 0)


@pytest.mark.slow
def test_a_search_that_ends_nowhere_tells_its_rounds_alone():
    status, *numbers, rounds = plainly(ellipse_fit)(drawn("parabola", 1) + drawn_noise())
    assert status == circles.NOT_SETTLED
    assert numbers == [0.0] * 6
    assert rounds > 0


def drawn_noise():
    return np.random.default_rng(3).normal(0.0, 1e-3, drawn("parabola", 1).shape)


@pytest.mark.parametrize(
    "xy",
    [np.ones((1, 2)), np.array([[1.0, math.inf], [2.0, 1.0]]), 1e160 * LINE, 1e-160 * LINE,
     np.zeros((3, 2)), LINE],
)  # fmt: skip
def test_points_that_no_ellipse_about_a_centre_fits(xy):
    x, y = np.ascontiguousarray(xy.T)
    assert plainly(origin_fit)(x, y, 1e-8, 100) == (NO_SPREAD, 0, 0, 0, 0)
    assert plainly(polar)(x, y)[:3] == (0.0, 0.0, 0.0)


def test_a_load_on_three_cells_gives_no_disc_but_their_number():
    loads = np.zeros((4, 5))
    loads[1, 1:4] = 7.0
    readings = Readings(loads, np.ones(loads.shape, bool), np.array([0.0, 0.0, 1.3, 1.0]), 1.0)
    assert plainly(even_disc)(readings) == (TOO_FEW, *[0.0] * 7, 3, 0)


@pytest.mark.parametrize("n", [1, 2, 5])
def test_cells_in_one_line_give_no_rectangle_but_their_middle(n):
    cells = np.column_stack([1.3 * np.arange(n) + 2.0, np.full(n, 4.0)])
    window = Window(cells, np.zeros((5, n + 4)), np.zeros((5, n + 4), np.uint8),
                    np.arange(n + 4.0), np.arange(5.0))  # fmt: skip
    found = plainly(likeliest)(window, LAW, 1.3)
    assert found == (ONE_LINE, pytest.approx(1.3 * (n - 1) / 2 + 2.0), 4.0, 0, 0, 0, 0, 0)


@pytest.mark.parametrize(
    ("step", "setting"),
    [
        ("fit_rectangle", "inside_cm"),
        ("rectangle_from_ellipse", "inside_cm"),
        ("rectangle_from_ellipse", "inside_cells"),
        ("rectangle_from_ellipse", "cell_cm"),
    ],
)
def test_what_moves_or_scales_an_answer_has_an_end(step, setting):
    node = f"{{step: {step}, in: frame, with: {{{setting}: .inf}}}}"
    with pytest.raises(PipelineError, match=f"{setting}: must be a finite number, got inf"):
        loads(f"pipeline: endless\nnodes: {{one: {node}}}\noutputs: [one]\n")
