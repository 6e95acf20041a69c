"""Grams from counts: more bits and less noise reach nearer to saturation, never past it."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from tactile_graph_pads.pad import load_pad
from tactile_graph_thesis.items.chapter_2.section_2_2_2_converter import (
    BITS,
    LOAD_G,
    NOISES_V,
    ConverterErrors,
    converter_errors,
    usable_g,
)


@cache
def found() -> ConverterErrors:
    return converter_errors(load_pad("thesis"), np.random.default_rng(0))


@pytest.mark.slow
def test_each_bit_halves_the_error_in_the_middle_of_the_range() -> None:
    middle = np.argmin(abs(LOAD_G - 60.0))
    error = found().of_bits_percent[:, middle]
    per_bit = (error[0] / error[-1]) ** (1.0 / (BITS[-1] - BITS[0]))
    assert 1.8 < per_bit < 2.2


@pytest.mark.slow
def test_the_range_within_5_percent_widens_with_bits() -> None:
    got = found()
    spans = [
        usable_g(LOAD_G, p, n) for p, n in zip(got.of_bits_percent, got.of_bits_lost, strict=True)
    ]
    tops = [top for _, top in spans]
    assert tops == sorted(tops)
    assert 100.0 < tops[0] < 300.0
    assert 800.0 < tops[BITS.index(12)] < 2500.0


@pytest.mark.slow
def test_nothing_is_lost_before_the_column_sum_comes_near_one() -> None:
    got = found()
    assert (got.of_bits_lost[BITS.index(12)][got.column_sum < 0.99] == 0.0).all()
    assert got.of_bits_lost[0, -1] > 0.5


def test_noise_narrows_the_range() -> None:
    got = found()
    tops = [
        usable_g(LOAD_G, p, n)[1]
        for p, n in zip(got.of_noise_percent, got.of_noise_lost, strict=True)
    ]
    assert len(tops) == len(NOISES_V)
    assert tops == sorted(tops, reverse=True)
    assert tops[-1] < 0.3 * tops[0]


def test_errors_and_shares_are_numbers() -> None:
    for values in found():
        assert np.isfinite(values).all()


def test_a_range_of_nothing_is_zero() -> None:
    assert usable_g(LOAD_G, np.full(34, 9.0), np.zeros(34)) == (0.0, 0.0)
