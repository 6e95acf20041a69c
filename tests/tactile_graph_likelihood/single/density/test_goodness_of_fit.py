"""The closed forms of what the model expects of its own log likelihood, against integrals."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import trapezoid as integral

from helpers_likelihood import NOISE
from helpers_modes import plainly
from tactile_graph_likelihood.single.density.element_terms import OFF, ON, ROOT_TWO_PI, SPAN
from tactile_graph_likelihood.single.density.goodness_of_fit import (
    DENSITY,
    moments_of_strays,
    moments_of_term,
    unexplained,
)


@pytest.mark.parametrize("z", [-2.0, 0.0, 1.3, 5.0])
def test_a_terms_mean_and_variance_are_those_of_the_integral(z: float) -> None:
    """With u normal: a reading's term where it shows, above -z, and the other's where not."""
    level, present, bare = -0.4, 0.83, -1e-3
    tail, density = 0.5 * math.erfc(-z / math.sqrt(2.0)), DENSITY * math.exp(-0.5 * z * z)
    off, mean, variance = moments_of_term(z, tail, density, level, present, bare)
    none = 1.0 - present * tail
    assert off == pytest.approx(bare + math.log(none), rel=1e-12)
    u = np.linspace(-z, 12.0, 400_001)
    weight = present * np.exp(-0.5 * u * u) / ROOT_TWO_PI
    term = level - 0.5 * u * u
    first, second = (integral(weight * term**k, u) + none * off**k for k in (1, 2))
    assert mean == pytest.approx(first, rel=1e-6)
    assert variance == pytest.approx(second - first**2, rel=1e-6)


def test_a_bare_elements_moments_are_those_of_two_outcomes() -> None:
    strays = 0.01
    outcomes = np.array([math.log(strays / SPAN), math.log(1.0 - strays)])
    chances = np.array([strays, 1.0 - strays])
    mean, variance = moments_of_strays(strays)
    assert mean == pytest.approx(chances @ outcomes, rel=1e-12)
    assert variance == pytest.approx(chances @ outcomes**2 - mean**2, rel=1e-9)


def test_readings_where_all_is_sure_to_read_nothing_are_a_surprise_and_still_a_number() -> None:
    """As on one line of elements, whose two ends are touched, under an outline far too large."""
    states = np.array([[ON], [OFF], [ON]], np.uint8)
    logs = np.where(states == ON, math.log(40.0), 0.0)
    covered, sure = np.ones((3, 1)), math.log(0.01)
    noise = NOISE.vector(1.3)
    found = plainly(unexplained)(covered, sure, 0, 0, logs, states, noise, 4)
    assert -math.inf < found.surprise < -3.0
