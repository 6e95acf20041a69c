"""A belief about sizes alone: what it is worth, and what it does to a posterior."""

import math

import numpy as np
import pytest

from helpers_likelihood import NOISE, drawn
from tactile_graph.wires import Circle, Rectangle
from tactile_graph_likelihood.geometry.outlines import DISC, RECTANGLE
from tactile_graph_likelihood.known.known_sizes import KnownSizes, sizes_of
from tactile_graph_likelihood.single.model import Model
from tactile_graph_likelihood.single.readings import readings_of

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("warm_kernels")]


def test_share_is_the_integral_of_belief_times_prior_and_the_mean_is_the_one_given():
    known, model = KnownSizes(np.array([5.0]), np.array([[0.09]])), Model(DISC, noise=NOISE)
    readings = readings_of(drawn(Circle(10.0, 9.5, 5.0), 60.0, np.random.default_rng(1)), 0.3, 5.0)
    mean, precision = known.belief(model)
    r = np.linspace(3.0, 7.0, 4001)
    span = math.log(model.largest_cm / model.smallest_cm)
    density = np.exp(-0.5 * precision[2, 2] * (r - mean[2]) ** 2) / (r * span)
    share = known.log_share(model, readings)
    assert share == pytest.approx(math.log(np.trapezoid(density, r)), abs=4e-3)
    by_the_pad = known.log_share(Model(DISC, smallest_cm=0.0, largest_cm=math.inf), readings)
    wide = math.log(math.hypot(20.5, 20.5) / (0.4 * 1.3))
    assert by_the_pad - share == pytest.approx(math.log(span / wide))
    assert np.trapezoid(r * density, r) / np.trapezoid(density, r) == pytest.approx(5.0, abs=2e-3)
    assert not precision[:2].any()


def test_true_sizes_raise_the_evidence_and_wrong_ones_lower_it():
    image = drawn(Rectangle(10.0, 9.5, 13.0, 6.0, 0.4), 60.0, np.random.default_rng(3))
    model, readings = Model(RECTANGLE, noise=NOISE, precision=0.08), readings_of(image, 0.3, 5.0)
    free = model.posterior(image).log_evidence
    gains = []
    for halves in ([6.5, 3.0], [6.5, 5.0]):
        known = KnownSizes(np.array(halves), 0.02**2 * np.eye(2))
        start = Rectangle(10.0, 9.5, 2 * halves[0], 2 * halves[1], 0.4)
        found = model.posterior(image, start, known.belief(model))
        gains.append(found.log_evidence - known.log_share(model, readings) - free)
    assert gains[0] > 1.0
    assert gains[1] < -20.0


@pytest.mark.parametrize(
    ("kind", "true", "orders"),
    [(DISC, Circle(10.0, 9.5, 5.0), 1.0), (RECTANGLE, Rectangle(10.0, 9.5, 13.0, 6.0, 0.4), 2.0)],
)
def test_evidence_is_that_of_a_normal_prior_in_place_of_the_models_own(kind, true, orders):
    image = drawn(true, 60.0, np.random.default_rng(4))
    model, readings = Model(kind, noise=NOISE, precision=0.08), readings_of(image, 0.3, 5.0)
    free = model.posterior(image)
    sizes = sizes_of(kind, free.mean, free.covariance)
    for width in (0.3, 0.5):
        wide = width**2 * np.eye(len(sizes.mean))
        known = KnownSizes(sizes.mean, wide)
        found = model.posterior(image, free.most_likely_shape, known.belief(model))
        got = found.log_evidence - known.log_share(model, readings) - free.log_evidence
        # at a likelihood narrow beside both; the model's own takes a rectangle's sides both ways
        span = math.log(model.largest_cm / model.smallest_cm)
        _, log_det = np.linalg.slogdet(2.0 * math.pi * (wide + sizes.covariance))
        expected = np.log(sizes.mean * span).sum() - 0.5 * log_det - math.log(orders)
        assert got == pytest.approx(expected, abs=0.12)


def test_the_longer_size_comes_first():
    mean, covariance = np.array([1.0, 2.0, 3.0, 6.0, 0.1]), np.diag([0.0, 0.0, 1.0, 4.0, 0.0])
    found = sizes_of(RECTANGLE, mean, covariance)
    assert found.mean.tolist() == [6.0, 3.0]
    assert np.diag(found.covariance).tolist() == [4.0, 1.0]
