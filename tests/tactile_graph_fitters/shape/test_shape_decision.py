"""Which shape an outline is of, and how sure that is."""

import math

import numpy as np
import pytest

from helpers_rectangles import covered, points, rectangle_xy
from tactile_graph import load
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Circle, Ellipse, Points, Polygon, Rectangle
from tactile_graph_fitters.shape.shape_decision import (
    EVIDENCE,
    FLOOR_CELLS,
    Fits,
    _best_polygon,
    shape_decision,
)
from tactile_graph_hull.boundary_scan import boundary_scan


def pentagon(radius=6.5):
    t = 0.3 + 2 * np.pi * np.arange(5) / 5
    return Polygon(np.column_stack([10 + radius * np.cos(t), 10 + radius * np.sin(t)]))


OUTLINES = {
    "disc": Circle(10, 10, 5.5).outline_cm(80),
    "ellipse": Ellipse(10, 10, 7, 4, 0.5).outline_cm(80),
    "rectangle": rectangle_xy(Rectangle(10, 10, 13, 7, 0.5), 80),
    "polygon": pentagon().xy_cm,
}


@pytest.mark.parametrize("kind", OUTLINES)
def test_clean_outlines_are_told_apart(kind):
    got = shape_decision(points(OUTLINES[kind]), cell_cm=0.5)
    assert got.kind == kind
    assert got.confidence > 0.95
    assert got.confidence == getattr(got, kind)
    assert got.disc + got.ellipse + got.rectangle + got.polygon == pytest.approx(1.0)
    assert got.corners == {"rectangle": 4, "polygon": 5}.get(kind, 0)


def test_the_shape_comes_with_the_decision():
    truth = Rectangle(10, 10, 13, 7, 0.5)
    got = shape_decision(points(rectangle_xy(truth, 80)), cell_cm=0.5).shape
    assert isinstance(got, Rectangle)
    assert (got.length_cm, got.breadth_cm) == pytest.approx((13.0, 7.0), abs=0.05)


@pytest.mark.slow
def test_what_a_shape_is_does_not_depend_on_how_the_pad_is_held_nor_on_its_pitch():
    for seed in range(6):
        centre = np.random.default_rng(seed).uniform(7.0, 9.0, 2)
        shape = Rectangle(*centre, 7.0, 4.0 + 0.4 * seed, seed)
        xy = boundary_scan(covered(shape, (32, 32))).xy_cm
        usual = shape_decision(Points(xy), cell_cm=1.0)
        for held, scale in ((xy * [-1.0, 1.0], 1.0), (xy[:, ::-1], 1.0), (0.1 * xy, 0.1)):
            got = shape_decision(Points(held.copy()), cell_cm=scale)
            assert got.kind == usual.kind
            assert got[4:] == pytest.approx(usual[4:], abs=1e-4)


def test_a_triangle_is_a_polygon_of_three_corners():
    got = shape_decision(points([[0, 0], [10, 0], [4, 8]]), cell_cm=0.5)
    assert (got.kind, got.corners) == ("polygon", 3)


def test_a_higher_temperature_makes_every_confidence_more_alike():
    xy = points(OUTLINES["ellipse"])
    sure, unsure = (shape_decision(xy, temperature=t, cell_cm=0.8) for t in (1.0, 5.0))
    assert sure.kind == unsure.kind == "ellipse"
    assert unsure.confidence < sure.confidence
    logs = [np.log([d.disc, d.ellipse, d.rectangle, d.polygon]) for d in (sure, unsure)]
    assert np.diff(logs[1]) == pytest.approx(np.diff(logs[0]) / 5.0)


@pytest.mark.parametrize("most", [3, 4, 6, 8])
def test_a_polygon_has_no_more_corners_than_it_may(most):
    t = 2 * np.pi * np.arange(7) / 7
    xy = np.column_stack([np.cos(t), np.sin(t)])
    along = np.linspace(0, 1, 12, endpoint=False)[:, None, None]
    outline = (xy * (1 - along) + np.roll(xy, -1, axis=0) * along).reshape(-1, 2) * 30
    got = shape_decision(points(outline), cell_cm=0.5, max_corners=most)
    assert got.kind != "polygon" or got.corners <= most
    assert got.corners in (0, 4) or got.corners == min(most, 7)


@pytest.mark.slow
def test_on_a_pad_of_16_cells_the_confidence_says_how_often_it_is_right():
    """Discs, ellipses and rectangles on an even pad: at least as often as it claims, nearly."""
    boxes = {
        "disc": {"shape": "disc", "radius_cm": 5.5},
        "ellipse": {"shape": "ellipse", "semi_major_cm": 7, "semi_minor_cm": 4},
        "rectangle": {"shape": "rectangle", "length_cm": 13, "breadth_cm": 7},
    }
    right, claimed = [], []
    clean = load("rectangle-1").runner(only=["clean"])
    for kind, box in boxes.items():
        scene = {"objects": [{**box, "weight_g": 3000}]}
        source = load("rectangle-1").with_source(
            "simulate", scene=scene, frames=12, sigma=0.0, voids=0.0
        )
        for frame in source.frames(3):
            got = shape_decision(boundary_scan(clean(frame)["clean"]))
            right.append(got.kind == kind)
            claimed.append(got.confidence)
    assert np.mean(right) > 0.85
    assert np.mean(right) > np.mean(claimed) - 0.1


def test_points_on_a_line_are_of_no_shape():
    with pytest.raises(Degenerate, match="3 points on one line: no shape to decide on"):
        shape_decision(points([[0, 0], [1, 1], [2, 2]]))


def test_a_small_blob_of_cells_gets_an_answer_that_is_not_sure():
    mask = covered(Rectangle(10, 10, 3.9, 3.9, 0.0), (16, 16), 1.3)
    got = shape_decision(boundary_scan(mask))
    assert math.isfinite(got.confidence)
    assert got.confidence < 0.9


def test_points_anywhere_on_the_pad_give_the_same_decision():
    xy = OUTLINES["rectangle"]
    here, there = (
        shape_decision(Points(xy.copy())),
        shape_decision(Points(xy + np.array([50.0, -30.0]))),
    )
    assert there.kind == here.kind
    assert there.confidence == pytest.approx(here.confidence, abs=1e-3)


@pytest.mark.parametrize("size", [1e6, 2.0**500, 1.7e308])
def test_points_of_no_pad_are_refused_in_words(size: float) -> None:
    t = np.linspace(0.0, 6.0, 40)
    with pytest.raises(Degenerate, match=r"100,000 cells of 1\.3 cm apart; is cell_cm right"):
        shape_decision(Points(size * np.column_stack([np.cos(t), np.sin(t)])), cell_cm=1.3)


def test_corners_are_paid_for_by_so_many_measurements_a_cell():
    """40 cells of outline are 24 measurements: two logarithms of 24 for a corner more."""
    floor = (FLOOR_CELLS * 1.0) ** 2
    assert 40.0 * EVIDENCE == 24.0
    price = 2.0 * math.log(24.0) / 24.0
    for share, corners in ((1.02, 4), (0.98, 3)):
        squares = np.array([9.0, 9.0, 9.0, floor * (2.0 * math.exp(share * price) - 1.0), floor])
        assert _best_polygon(Fits(5, 40.0, squares, squares, squares), 4, 1.0) == corners
