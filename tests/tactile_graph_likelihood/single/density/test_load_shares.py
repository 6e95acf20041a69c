"""Faces that press unevenly: the pressure's mean over elements, and what is made of it."""

import math
from dataclasses import replace

import numpy as np
import pytest

from helpers_likelihood import GRID, NOISE, made
from helpers_modes import plainly
from tactile_graph.wires import Circle, Ellipse, Image, Polygon, Rectangle
from tactile_graph_likelihood.geometry.outlines import DISC, packed
from tactile_graph_likelihood.single.any_pressure import (
    CLEAR,
    FOAM_ODDS,
    ROUND,
    AnyPressure,
    chances,
    mixed,
)
from tactile_graph_likelihood.single.density.element_terms import FALL, LEAN_X, LEAN_Y
from tactile_graph_likelihood.single.density.load_shares import (
    foam_weights,
    passed_on,
    press,
    shares_of,
)
from tactile_graph_likelihood.single.fit_footprint import FitFootprint
from tactile_graph_likelihood.single.footprint_of import FootprintDisc, FootprintRectangle
from tactile_graph_likelihood.single.model import Model
from tactile_graph_pads.contact import spread
from tactile_graph_pads.geometry import Geometry

pytestmark = pytest.mark.usefixtures("warm_kernels")

FINE, COARSE = 48, 16
"""Places along an element's side: for a reference, and for readings that scatter anyway."""
SHAPES = [
    Circle(9.1, 8.7, 5.2),
    Ellipse(10.0, 9.0, 7.0, 4.0, 0.7),
    Rectangle(10.0, 9.0, 13.0, 6.0, -0.4),
    Polygon(np.array([[4.0, 12.0], [10.0, 2.5], [16.0, 12.0]])),
]


def distances(shape, x, y):
    """Return each place's distance from the middle over the outline's in its direction."""
    if isinstance(shape, Circle):
        return np.hypot(x - shape.x_cm, y - shape.y_cm) / shape.radius_cm
    if isinstance(shape, Polygon):
        xy = shape.xy_cm
        middle = xy.mean(axis=0)
        out = np.zeros(x.shape)
        for a, b in zip(xy, np.roll(xy, -1, axis=0), strict=True):
            normal = np.array([b[1] - a[1], a[0] - b[0]])
            height = normal @ (a - middle)
            out = np.maximum(
                out, (normal[0] * (x - middle[0]) + normal[1] * (y - middle[1])) / height
            )
        return out
    cos, sin = math.cos(shape.angle_rad), math.sin(shape.angle_rad)
    u = (x - shape.x_cm) * cos - (y - shape.y_cm) * sin
    v = (x - shape.x_cm) * sin + (y - shape.y_cm) * cos
    if isinstance(shape, Ellipse):
        return np.hypot(u / shape.semi_major_cm, v / shape.semi_minor_cm)
    return np.maximum(2 * np.abs(u) / shape.length_cm, 2 * np.abs(v) / shape.breadth_cm)


def half_axes(shape):
    """Return half the length and half the breadth of an ellipse or a rectangle."""
    if isinstance(shape, Ellipse):
        return shape.semi_major_cm, shape.semi_minor_cm
    return 0.5 * shape.length_cm, 0.5 * shape.breadth_cm


def along_axes(shape):
    """Return the directions of an outline's axes, right and down, as columns."""
    cos, sin = math.cos(shape.angle_rad), math.sin(shape.angle_rad)
    return np.array([[cos, sin], [-sin, cos]])


def by_places(shape, fall, lean, fine=FINE):
    """Return the pressure's mean over each element, from many places on it."""
    steps = (np.arange(fine) + 0.5) / fine
    at = (1.3 * np.arange(16)[:, None] + steps[None, :]).ravel()
    x, y = np.meshgrid(at, at)
    r = distances(shape, x, y)
    extent = 0.5 * np.ptp(shape.outline_cm(), axis=0).max()
    middle = shape.xy_cm.mean(axis=0) if isinstance(shape, Polygon) else (shape.x_cm, shape.y_cm)
    pressure = np.where(r < 1.0, (1 + fall) * np.maximum(1 - r * r, 1e-9) ** fall, 0.0)
    right, down = x - middle[0], y - middle[1]
    if isinstance(shape, Ellipse | Rectangle):
        axes = along_axes(shape)
        stretched = axes @ np.diag(1.0 / np.array(half_axes(shape))) @ axes.T
        lean = stretched @ np.array(lean) * extent
    pressure *= np.exp((lean[0] * right + lean[1] * down) / extent)
    return pressure.reshape(16, fine, 16, fine).mean(axis=(1, 3))


def by_kernel(shape, fall, lean, which="call"):
    kind, corners, p = packed(shape)
    noise = NOISE.vector(1.3)
    noise[FALL], noise[LEAN_X], noise[LEAN_Y] = fall, *lean
    return getattr(shares_of, which)(kind, corners, p, GRID, noise, (0, 0, 16, 16), 16, 16)


@pytest.mark.slow
@pytest.mark.parametrize("shape", SHAPES, ids=lambda s: type(s).__name__)
@pytest.mark.parametrize(
    ("fall", "lean"), [(0.0, (0.9, -0.5)), (0.5, (0.0, 0.0)), (1.0, (0.3, 0.2)), (-0.4, (0.0, 0.0))]
)
def test_the_pressure_of_an_element_is_its_mean_over_it(shape, fall, lean):
    expected, found = by_places(shape, fall, lean), by_kernel(shape, fall, lean)
    inside = by_places(shape, 0.0, (0.0, 0.0)) > 0.999
    off = np.abs(found - expected)
    assert off[inside].max() < 0.16 * (1 + fall)  # a rectangle's edges have kinks
    assert off[inside].mean() < 0.025 * (1 + fall)
    assert off.mean() < 0.012 * (1 + fall)
    assert found.sum() == pytest.approx(expected.sum(), rel=0.04)
    assert np.isfinite(found).all()


@pytest.mark.slow  # much is compiled
@pytest.mark.parametrize("shape", SHAPES[1:3], ids=lambda s: type(s).__name__)
def test_a_lean_across_is_as_large_as_one_along(shape):
    even = by_kernel(shape, 0.0, (0.0, 0.0))
    at = 1.3 * np.arange(16) + 0.5
    x, y = np.meshgrid(at - shape.x_cm, at - shape.y_cm)
    for half, (right, down) in zip(half_axes(shape), along_axes(shape).T, strict=True):
        leaning = by_kernel(shape, 0.0, (0.6 * right, 0.6 * down))
        expected = even * np.exp(0.6 * (x * right + y * down) / half)
        np.testing.assert_allclose(leaning, expected, rtol=1e-9)


@pytest.mark.slow  # much is compiled
@pytest.mark.parametrize("fall", [-0.4, 0.3, 1.0])
def test_a_falling_pressure_has_the_mean_of_an_even_one(fall):
    even, found = (by_kernel(SHAPES[0], f, (0.0, 0.0)).sum() for f in (0.0, fall))
    assert found == pytest.approx(even, rel=0.03)


@pytest.mark.slow
@pytest.mark.parametrize("shape", SHAPES, ids=lambda s: type(s).__name__)
def test_plain_and_compiled_agree(shape):
    kind, corners, p = packed(shape)
    noise = NOISE.vector(1.3)
    noise[FALL], noise[LEAN_X] = 0.6, -0.3
    one, other = np.ones((2, 16, 16))
    plainly(press)(kind, corners, p, GRID, noise, (0, 0, 16, 16), one)
    press.compiled(kind, corners, p, GRID, noise, (0, 0, 16, 16), other)
    np.testing.assert_allclose(one, other, rtol=1e-12)


def frames(n, seed, fall=0.0, lean=0.0, shape=None):
    """Give discs that press so, on the pad that the model has in mind."""
    rng = np.random.default_rng(seed)
    for _ in range(n):
        radius, way = rng.uniform(5.0, 7.5), rng.uniform(0.0, 2.0 * math.pi)
        disc = shape or Circle(*rng.uniform(radius, 20.5 - radius, 2), radius)
        leans = lean * math.cos(way), lean * math.sin(way)
        load = 70.0 * by_places(disc, fall, leans, COARSE)
        load *= np.exp(0.48 * rng.standard_normal(load.shape)) * (rng.random(load.shape) >= 0.16)
        yield disc, Image(np.where(load < 5.0, 0.0, load), (1.3, 1.3), (-0.15, -0.15), "gram")


def errors(step, seen):
    """Return the mean errors of centre and radius, and the share of regions with the truth."""
    rows = []
    for disc, image in seen:
        found = step(image)
        off = math.hypot(found.x_cm - disc.x_cm, found.y_cm - disc.y_cm)
        inside = found.posterior.contains(disc)
        rows.append((off, abs(found.radius_cm - disc.radius_cm), inside))
    return np.mean(rows, axis=0)


SETTINGS = {"sigma": 0.48, "voids": 0.16, "shows_from": 5.0, "gap_cm": 0.3, "on_pad": "whole"}


@pytest.mark.slow
def test_a_ball_and_a_lean_are_located_better_than_by_an_even_face():
    steps = [made(FootprintDisc, pressure=p, **SETTINGS) for p in ("any", "even")]
    ball = [errors(step, frames(40, 1, fall=0.5)) for step in steps]
    assert ball[0][1] < 0.5 * ball[1][1]
    assert ball[0][2] > 0.7 > 0.2 > ball[1][2]
    leaning = [errors(step, frames(40, 2, lean=1.1)) for step in steps]
    assert leaning[0][0] < 0.5 * leaning[1][0]
    assert leaning[0][2] > 0.65 > 0.2 > leaning[1][2]


@pytest.mark.slow
def test_an_even_face_loses_nothing_by_the_question():
    steps = [made(FootprintDisc, pressure=p, **SETTINGS) for p in ("any", "even")]
    asked, plain = (errors(step, frames(60, 3)) for step in steps)
    assert asked[0] < 1.05 * plain[0]
    assert asked[1] < 1.1 * plain[1]


@pytest.mark.slow
def test_only_what_leaves_a_pattern_is_looked_at_again():
    model = Model(DISC, noise=NOISE, whole=True)
    again = 0
    for _, image in frames(40, 4):
        found, even = AnyPressure(model).posterior(image), model.posterior(image)
        looked = max(even.lean, even.fall) >= CLEAR.fall or even.neighbours >= CLEAR.alike
        again += looked
        if not looked:
            assert set(found.pressures) == {"even"}
            np.testing.assert_array_equal(found.mean, even.mean)
    assert 0 < again < 12


@pytest.mark.slow
def test_the_mixture_is_weighed_by_evidence_and_what_was_thought_before():
    model = Model(DISC, noise=NOISE, whole=True)
    _, image = next(frames(1, 5, fall=0.6))
    any_pressure = AnyPressure(model)
    even, fall = model.posterior(image), any_pressure.others["fall"].posterior(image)
    found = mixed({"even": even, "fall": fall}, {"even": 0.8, "fall": 0.2})
    odds = math.log(0.2 / 0.8)
    odds += fall.log_evidence - even.log_evidence
    share = found.pressures["fall"]
    assert math.log(share / (1.0 - share)) == pytest.approx(odds, rel=1e-7)
    assert sum(found.pressures.values()) == pytest.approx(1.0)
    assert found.weights.sum() == pytest.approx(1.0)
    expected = share * fall.mean[:4] + (1.0 - share) * even.mean
    np.testing.assert_allclose(found.mean, expected, rtol=1e-9)


def test_what_is_known_or_estimated_is_not_asked_again():
    def asked(**settings):
        return set(AnyPressure(made(FootprintDisc, **settings).model).others)

    assert asked() == {"lean", "fall", "foam"}
    assert asked(estimate=["fall"]) == {"lean", "foam"}
    assert asked(foam_cm=0.4) == {"lean", "fall"}


@pytest.mark.slow
@pytest.mark.parametrize("step", [FootprintRectangle, FitFootprint])
def test_a_fall_can_be_estimated_with_any_object(step):
    settings = {"shape": "rectangle"} if step is FitFootprint else {}
    slab = Rectangle(10.0, 10.0, 15.0, 9.0, 0.3)
    _, image = next(frames(1, 6, fall=0.5, shape=slab))
    found = made(step, **settings, **SETTINGS, estimate=["fall", "lean"])(image)
    assert len(found.posterior.mean) == 9
    assert 0.1 < found.posterior.mean[6] < 0.9
    assert np.abs(found.posterior.mean[7:]).max() < 0.6
    assert found.length_cm == pytest.approx(15.0, abs=1.0)


@pytest.mark.slow
def test_foam_is_told_from_a_ball_by_what_neighbours_share():
    model = Model(DISC, noise=NOISE, whole=True)
    _, image = next(frames(1, 5, fall=0.6))
    any_pressure = AnyPressure(model)
    others = {part: any_pressure.others[part].posterior(image) for part in ("fall", "foam")}
    foam = []
    for neighbours in (-1.0, 0.0, 2.0, 3.5, 30.0):
        others["fall"] = replace(others["fall"], neighbours=neighbours)
        found = chances(others)
        assert found["fall"] + found["foam"] == pytest.approx(ROUND)
        foam.append(found["foam"] / ROUND)
    assert foam == sorted(foam)
    assert foam[1] < 0.02
    assert foam[3] > 0.8
    assert chances({"foam": others["foam"]}) == {"even": 1.0 - ROUND, "foam": ROUND}
    fewer = chances({**others, "fall": replace(others["fall"], neighbours=2.0)}, 30)
    assert fewer["foam"] / ROUND > 2.0 * foam[2]  # among few elements, few neighbours are alike
    unknown = chances({"fall": None, "foam": None})
    assert unknown["foam"] / unknown["fall"] == pytest.approx(FOAM_ODDS)
    own = chances({**others, "fall": replace(others["fall"], neighbours=0.0)}, 80, 0.0, 0.5)
    assert own["foam"] / own["fall"] == pytest.approx(0.5)  # whatever neighbours are like


@pytest.mark.slow
def test_foam_nobody_told_of_is_found():
    steps = [made(FootprintDisc, pressure=p, **SETTINGS) for p in ("any", "even")]
    pad = Geometry()
    soft = [
        (disc, image.with_values(np.where(blurred < 5.0, 0.0, blurred)))
        for disc, image in frames(30, 7)
        if (blurred := spread(image.values, pad, 1.0)).any()
    ]
    found, even = (errors(step, soft) for step in steps)
    assert found[1] < 0.5 * even[1]
    images = [image for _, image in soft]
    assert np.mean([steps[0](image).posterior.pressures.get("foam", 0.0) for image in images]) > 0.7
    balls = [image for _, image in frames(30, 8, fall=0.5)]
    assert np.mean([steps[0](image).posterior.pressures.get("foam", 0.0) for image in balls]) < 0.1


@pytest.mark.slow
def test_foam_wider_than_the_pad_takes_no_longer_the_wider_it_is():
    """Loads were carried over as many cells as foam is wide, nearly all beyond the pad."""
    values, box = np.zeros((16, 16)), (0, 0, 16, 16)
    values[5:9, 4:12] = 1.0
    wide, wider = (passed_on.call(values, width, box, 16, 16) for width in (1e3, 1e6))
    assert wide == pytest.approx(np.full((16, 16), values.sum() / 256), rel=1e-3)
    assert wider == pytest.approx(wide, rel=1e-3)
    assert len(foam_weights.call(1e9, 16)) == 17
    assert foam_weights.call(0.7, 16) == pytest.approx(foam_weights.call(0.7, 1000), abs=0.0)
