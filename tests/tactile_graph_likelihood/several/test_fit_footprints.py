"""Several outlines found at once, in images that the model itself has made."""

import math

import numpy as np
import pytest

from helpers_likelihood import NOISE, made
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Circle, Image, Rectangle
from tactile_graph_likelihood.geometry.covered import covered
from tactile_graph_likelihood.geometry.outlines import packed
from tactile_graph_likelihood.several.fit_footprints import FitFootprints
from tactile_graph_likelihood.single.likely import LikelyCircle, LikelyRectangle

GRID = np.array([0.0, 0.0, 1.3, 1.0, 0.0, 0.0])
FIT = made(FitFootprints)
PAIR = [Circle(6.0, 7.0, 3.0), Circle(12.1, 7.4, 3.1)]
THREE = [Rectangle(5.0, 5.0, 7.0, 4.0, 0.3), Circle(14.5, 5.5, 2.8), Circle(9.0, 15.0, 3.4)]

pytestmark = [
    pytest.mark.slow,  # the kernels alone compile for half a minute
    pytest.mark.usefixtures("warm_kernels"),
]


def image_of(shapes, seed, loads=(90.0, 90.0, 90.0)):
    rng = np.random.default_rng(seed)
    load = np.zeros((16, 16))
    for shape, full in zip(shapes, loads, strict=False):
        kind, corners, p = packed(shape)
        load += full * covered.call(kind, corners, p, GRID, (0, 0, 16, 16))
    load *= np.exp(NOISE.sigma * rng.standard_normal(load.shape))
    load[(rng.random(load.shape) < NOISE.voids) | (load < NOISE.least)] = 0.0
    return Image(load, (1.3, 1.3), (-0.15, -0.15), "gram")


def nearest(found, shape):
    return min(math.hypot(f.x_cm - shape.x_cm, f.y_cm - shape.y_cm) for f in found.shapes)


def test_one_disc_stays_one_disc():
    for seed in range(8):
        found = FIT(image_of([Circle(9.0, 11.0, 4.5)], seed))
        assert found.count == len(found.shapes) == 1
        assert found.fits
        assert nearest(found, Circle(9.0, 11.0, 4.5)) < 0.5


def test_a_long_thin_rectangle_stays_whole():
    slab = Rectangle(10.0, 10.0, 15.0, 3.5, 0.5)
    counts = [FIT(image_of([slab], seed)).count for seed in range(8)]
    assert counts.count(1) >= 7


def test_two_discs_that_touch_are_told_apart():
    found = [FIT(image_of(PAIR, seed)) for seed in range(12)]
    right = [f for f in found if f.count == 2]
    assert len(right) >= 9
    errors = [nearest(f, shape) for f in right for shape in PAIR]
    assert np.mean(errors) < 0.25


def test_three_objects_each_with_its_kind_load_and_place():
    right = 0
    for seed in range(6):
        found = FIT(image_of(THREE, seed, (60.0, 90.0, 140.0)))
        assert found.count == 3
        assert 0.5 < found.count_probability <= 1.0
        assert max(nearest(found, shape) for shape in THREE) < 0.8
        best = min(found.shapes, key=lambda s: math.hypot(s.x_cm - 5.0, s.y_cm - 5.0))
        right += isinstance(best, LikelyRectangle)
    assert right >= 4


def test_kinds_most_and_starts_are_heeded():
    image = image_of(PAIR, 3)
    discs = made(FitFootprints, kinds=["disc"])(image)
    assert all(isinstance(s, LikelyCircle) for s in discs.shapes)
    assert made(FitFootprints, most=1)(image).count == 1
    started = FIT(image, [*PAIR])
    assert started.count == 2
    assert started.log_evidence >= FIT(image).log_evidence - 1e-9


def test_the_answer_is_the_same_each_time_and_tells_its_uncertainty():
    image = image_of(THREE, 1)
    one, other = FIT(image), FIT(image)
    assert one.log_evidence == other.log_evidence
    for a, b in zip(one.shapes, other.shapes, strict=True):
        assert (a.posterior.mean == b.posterior.mean).all()
        assert 0.01 < a.centre_std_cm < 1.0  # the rectangle may be two
        assert np.linalg.eigvalsh(a.posterior.covariance).min() > 0.0
    assert sorted(shape.centre_std_cm for shape in one.shapes)[1] < 0.2


def test_a_touching_neighbour_adds_to_the_uncertainty():
    far = [PAIR[0], Circle(16.0, 14.0, 3.1)]
    stds = []
    for shapes in (PAIR, far):
        some = []
        for seed in range(8):
            found = FIT(image_of(shapes, seed), shapes)
            if found.count == 2:
                some.append(min(found.shapes, key=lambda s: s.x_cm).centre_std_cm)
        stds.append(np.median(some))
    assert stds[0] > stds[1]


def test_an_empty_pad_and_wrong_sizes_are_told():
    with pytest.raises(Degenerate, match="no element"):
        FIT(Image(np.zeros((16, 16)), (1.3, 1.3), (-0.15, -0.15), "gram"))
    with pytest.raises(ValueError, match="smallest_cm"):
        made(FitFootprints, smallest_cm=3.0, largest_cm=2.0)
