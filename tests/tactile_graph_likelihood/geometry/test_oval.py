"""Ellipses in the numbers they are searched for in, and sizes that follow the pad."""

import math

import numpy as np
import pytest

from helpers_likelihood import GRID, NOISE, drawn, made
from helpers_modes import compiled, plainly
from tactile_graph.wires import Circle, Image
from tactile_graph_likelihood.geometry.covered import covered, window
from tactile_graph_likelihood.geometry.outlines import DISC, ELLIPSE, OVAL, bounds
from tactile_graph_likelihood.geometry.oval import as_ellipse, log_stretch, to_ellipses, to_oval
from tactile_graph_likelihood.single.footprint_of import FootprintDisc
from tactile_graph_likelihood.single.model import Model

pytestmark = pytest.mark.usefixtures("warm_kernels")


def ovals(n):
    rng = np.random.default_rng(1)
    for _ in range(n):
        yield np.array([*rng.uniform(5, 15, 2), *rng.uniform(1, 6, 2), rng.uniform(-2, 2), 4.0])


@pytest.mark.slow
@pytest.mark.parametrize("by", [plainly, compiled])
def test_an_oval_is_the_ellipse_it_was_made_of(by):
    for ellipse in ovals(20):
        oval = ellipse.copy()
        by(to_oval)(oval)
        back = by(as_ellipse)(oval)
        assert back[2] >= back[3]
        assert sorted(back[2:4]) == pytest.approx(sorted(ellipse[2:4]))
        box = by(window)(OVAL, 0, oval, GRID, 16, 16, 0.0)
        assert box == by(window)(ELLIPSE, 0, ellipse, GRID, 16, 16, 0.0)
        np.testing.assert_allclose(
            by(covered)(OVAL, 0, oval, GRID, box),
            by(covered)(ELLIPSE, 0, ellipse, GRID, box),
            atol=1e-11,
        )
        np.testing.assert_allclose(
            by(bounds)(OVAL, 0, oval), by(bounds)(ELLIPSE, 0, ellipse), atol=1e-11
        )


def test_the_stretch_is_the_volume_that_differences_give():
    for ellipse in ovals(10):
        columns = []
        for k in (2, 3, 4):
            up, down = ellipse.copy(), ellipse.copy()
            up[k] += 1e-6
            down[k] -= 1e-6
            to_oval.call(up)
            to_oval.call(down)
            columns.append((up[2:5] - down[2:5]) / 2e-6)
        volume = abs(np.linalg.det(np.array(columns)))
        oval = ellipse.copy()
        to_oval.call(oval)
        assert log_stretch.call(oval) == pytest.approx(-math.log(volume), abs=1e-6)


def test_ovals_around_one_angle_become_ellipses_around_it():
    rng = np.random.default_rng(2)
    points = np.array([[8.0, 9.0, 5.0, -0.5, 0.02, 4.0]]) + rng.normal(0, 0.01, (40, 6))
    to_ellipses.call(points, np.full(40, 1 / 40))
    assert np.ptp(points[:, 4]) < 0.1
    assert (points[:, 2] > points[:, 3]).all()


def test_sizes_follow_the_pad_unless_given():
    from tactile_graph_likelihood.single.readings import readings_of

    image = Image(np.ones((64, 32)), (0.5, 0.5), (0.0, 0.0), "gram")
    readings = readings_of(image, 0.1, 0.5)
    low, high = made(FootprintDisc).model.range_cm(readings)
    assert low == pytest.approx(0.2)
    assert high == pytest.approx(math.hypot(31.9, 15.9))
    assert made(FootprintDisc, smallest_cm=1.0, largest_cm=40.0).model.range_cm(readings) == (
        1.0,
        40.0,
    )


@pytest.mark.usefixtures("plain_kernels")  # sooner than a search is compiled for a large pad
def test_readings_far_away_do_not_lead_the_search_astray():
    rng, shape = np.random.default_rng(3), Circle(9.0, 9.0, 4.0)
    image = drawn(shape, 60.0, rng)
    values = np.zeros((64, 64))
    values[:16, :16] = image.values
    far = rng.integers(40, 64, (3, 2))
    values[far[:, 0], far[:, 1]] = 20.0
    model = Model(DISC, noise=NOISE, largest_cm=60.0)
    found = model.posterior(Image(values, image.pitch_cm, image.origin_cm, "gram"))
    assert found.mean[:3] == pytest.approx([9.0, 9.0, 4.0], abs=0.4)
