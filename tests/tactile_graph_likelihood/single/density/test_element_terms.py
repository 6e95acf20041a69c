"""The likelihood of single elements: a density, whatever the load, and twins that agree."""

import math

import numpy as np
import pytest

import references_likelihood as references
from helpers_modes import compiled, plainly
from tactile_graph_likelihood.single.density.element_terms import (
    HIGH,
    OFF,
    ON,
    OVER,
    SPAN,
    UNDER,
    UNKNOWN,
    terms,
)

NOISE = np.array([0.48, 0.16, 1e-3, math.log(5.0), 0.0, 0.0, 0.0, 0.0, 1.0])


@pytest.fixture(params=["reference", "compiled"])
def kernel(request):
    return getattr(terms, request.param)


def one(kernel, expected, log, state, noise=NOISE):
    load, states = math.log(expected), np.array([[state]], np.uint8)
    found = kernel(np.array([[1.0]]), load, 0, 0, np.array([[log]]), states, noise)
    stray = {ON: noise[2] / SPAN, UNKNOWN: 1.0}  # what it says where nothing lies on the pad
    return found + math.log(stray.get(state, 1.0 - noise[2]))


@pytest.mark.slow
@pytest.mark.parametrize("expected", [2.0, 6.0, 40.0, 500.0])
def test_an_elements_readings_have_probability_one(kernel, expected):
    # The lognormal part above the least load, the stray part over its own range.
    logs = np.linspace(math.log(5.0), math.log(5.0) + SPAN, 4001)
    density = [math.exp(one(kernel, expected, x, ON)) for x in logs]
    total = np.trapezoid(density, logs) + math.exp(one(kernel, expected, 0.0, OFF))
    assert total == pytest.approx(1.0, abs=2e-5)


def test_a_covered_element_that_reads_nothing_is_about_as_likely_as_a_void(kernel):
    assert one(kernel, 1e4, 0.0, OFF) == pytest.approx(math.log(0.16 * 0.999), abs=1e-6)


def test_a_broken_element_says_nothing(kernel):
    assert one(kernel, 40.0, 3.0, UNKNOWN) == 0.0


def test_a_reading_far_from_what_is_expected_is_a_stray(kernel):
    assert one(kernel, 6.0, 9.0, ON) == pytest.approx(math.log(1e-3 / SPAN), abs=1e-3)


def test_an_element_reads_nothing_as_far_as_its_own_least_load_goes(kernel):
    here, elsewhere = math.log(50.0), NOISE.copy()
    elsewhere[3] = here
    assert one(kernel, 40.0, here, UNDER) == pytest.approx(one(kernel, 40.0, 0.0, OFF, elsewhere))
    assert one(kernel, 40.0, here, UNDER) > one(kernel, 40.0, 0.0, OFF)


@pytest.mark.parametrize(("expected", "chance"), [(1e4, 0.84 * 0.999), (50.0, 0.42 * 0.999)])
def test_an_element_reads_the_most_as_likely_as_it_bears_that(kernel, expected, chance):
    found = kernel(
        np.array([[1.0]]),
        math.log(expected),
        0,
        0,
        np.array([[math.log(50.0)]]),
        np.array([[OVER]], np.uint8),
        NOISE,
    )
    assert found == pytest.approx(math.log1p(chance / (HIGH * 1e-3)), rel=1e-4)


@pytest.mark.parametrize("by", [plainly, compiled])
def test_twins_agree_on_windows_of_an_image(by):
    rng = np.random.default_rng(3)
    for _ in range(20):
        logs = rng.normal(3.0, 1.5, (9, 8))
        states = rng.integers(0, 5, (9, 8)).astype(np.uint8)
        shares = np.exp(rng.normal(0.0, 2.0, (4, 5))) * (rng.random((4, 5)) < 0.7)
        noise = NOISE.copy()
        noise[[0, 1, 3, 8]] = rng.uniform(0.05, 1), rng.uniform(0.01, 0.5), 1.6, rng.uniform(0.5, 2)
        args = (shares, 3.0, 3, 2, logs, states, noise)
        expected = pytest.approx(references.terms(*args), rel=1e-11)
        assert by(terms)(*args) == expected
