"""Calibrating the simulated pad as section 2.4.2 does gives a curve that can be used."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph_pads.calibration.calibration import Polynomial
from tactile_graph_pads.pad import load_pad
from tactile_graph_thesis.items.chapter_2.figure_2_18_calibration_curve import Curves, curves
from tactile_graph_thesis.measure.groups_of_four import group_readings


def curve(name: str) -> Curves:
    pad = load_pad(name)
    return curves(pad, group_readings(pad, np.random.default_rng(0)))


@pytest.mark.slow
def test_the_fifth_order_polynomial_is_within_the_error_bars() -> None:
    found = curve("thesis")
    polynomial = found.calibrations[0]
    assert isinstance(polynomial.fit, Polynomial)
    assert len(polynomial.fit.coefficients) == 6
    assert polynomial.quality.rms_percent < 12.0
    np.testing.assert_allclose(found.fitted_g[0], polynomial.fit.grams(found.reading_v))


def test_on_an_even_pad_the_curve_is_close_to_the_law() -> None:
    found = curve("plain")
    off = found.calibrations[1].grams_of(found.true_v).load_g / found.load_g - 1.0
    middle = (found.load_g > 20.0) & (found.load_g < 200.0)
    assert abs(off[middle]).max() < 0.1


def test_a_power_law_is_right_in_no_range_of_volts() -> None:
    found = curve("plain")
    power, polynomial = found.off_percent[2], found.off_percent[0]
    assert np.sqrt((power**2).mean()) > 3.0 * np.sqrt((polynomial**2).mean())
