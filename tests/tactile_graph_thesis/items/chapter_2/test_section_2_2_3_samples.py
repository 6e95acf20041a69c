"""10 samples serve as well as 100, as soon as the pad's own repeatability counts."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tactile_graph_pads.pad import load_pad
from tactile_graph_pads.scan import Converter
from tactile_graph_thesis.items.chapter_2.section_2_2_3_samples import (
    SAMPLES_TRIED,
    sample_errors,
    scan_error_v,
)

FOUND = sample_errors(load_pad("thesis"), np.random.default_rng(0))
TEN, HUNDRED = SAMPLES_TRIED.index(10), SAMPLES_TRIED.index(100)


def test_where_noise_reaches_a_step_the_error_falls_with_the_root_of_the_samples() -> None:
    error = FOUND.error_v[list(FOUND.noise_v).index(0.002)]
    assert error[TEN] / error[HUNDRED] == pytest.approx(np.sqrt(10.0), rel=0.1)


def test_quieter_readings_keep_the_rounding() -> None:
    assert FOUND.error_v[0, -1] > 0.15 * FOUND.step_v
    assert FOUND.error_v[0, -1] < FOUND.step_v / np.sqrt(12.0)


def test_beside_the_pads_repeatability_ten_is_as_good_as_hundred() -> None:
    total = FOUND.total_v[1]
    assert total[TEN] < 1.001 * total[HUNDRED]
    assert FOUND.repeatability_v > 20.0 * FOUND.error_v[1, TEN]


def test_a_scan_of_100_samples_takes_less_than_a_minute() -> None:
    assert 30.0 < FOUND.frame_s[HUNDRED] < 60.0


def test_an_ideal_converter_has_no_step() -> None:
    pad = replace(load_pad("plain"), converter=Converter(bits=None))
    found = sample_errors(pad, np.random.default_rng(0))
    assert found.step_v == 0.0
    assert found.repeatability_v == pytest.approx(0.0, abs=1e-12)
    error = found.error_v[0]
    assert error[TEN] / error[HUNDRED] == pytest.approx(np.sqrt(10.0), rel=0.1)


def test_ten_samples_serve_as_well_as_hundred_beside_the_step_of_the_converter() -> None:
    volts = np.random.default_rng(1).uniform(0.0, 2.0, (16, 16))
    one, ten, hundred = scan_error_v([1, 10, 100], volts, np.random.default_rng(0))
    assert one > ten > hundred
    assert ten < 0.5 * 2.44e-3
