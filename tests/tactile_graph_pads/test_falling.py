"""Which way readings go under pressure, and what elements rest at beside much that is pressed."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph_pads.falling import (
    fall_of,
    level_at_rest,
    rest_among,
    resting_with_the_pad,
)

SHAPE = (10, 12)
READ = np.ones(SHAPE, np.bool_)


def noise(n: int = 40, seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).normal(220.0, 1.0, (n, *SHAPE))


def pressed(by: float, frames: slice = slice(10, 30), lobe: float = 0.0) -> np.ndarray:
    """Return frames in some of which a patch reads more by so much, and those around it."""
    values = noise()
    values[frames, 2:9, 2:9] += lobe
    values[frames, 4:7, 4:7] += by - lobe
    return values


@pytest.mark.parametrize("lobe", [0.0, 20.0])
def test_patches_that_fall_are_told_with_their_frames_and_depth(lobe: float) -> None:
    found = fall_of(pressed(-60.0, lobe=lobe), 220.0, 1.0, READ)
    assert found is not None
    assert found.frames == 20
    assert found.most == pytest.approx(62.0, abs=2.0)


@pytest.mark.parametrize("lobe", [0.0, -20.0])
def test_what_falls_beside_a_press_that_rises_farther_is_no_fall(lobe: float) -> None:
    assert fall_of(pressed(60.0, lobe=lobe), 220.0, 1.0, READ) is None
    assert fall_of(noise(), 220.0, 1.0, READ) is None


def test_frames_without_any_reading_tell_nothing() -> None:
    for by in (-60.0, 60.0):
        values = pressed(by)
        values[:10] = np.nan
        found = fall_of(values, 220.0, 1.0, READ)
        assert (found.frames if found else 0) == (20 if by < 0.0 else 0)
        assert rest_among(values, READ, 0.0).noise == pytest.approx(1.0, abs=0.3)
    assert fall_of(np.full_like(values, np.nan), 220.0, 1.0, READ) is None


def test_single_elements_that_come_loose_are_no_fall() -> None:
    values = pressed(60.0)
    values[::2, 0, 0] = 0.0
    values[1::3, 9, 3] = 0.0
    assert fall_of(values, 220.0, 1.0, READ) is None


def test_where_some_fall_and_others_rise_in_turn_nothing_is_said() -> None:
    values = pressed(-60.0)
    values[32:38, 4:7, 4:7] += 60.0
    assert fall_of(values, 220.0, 1.0, READ) is None


def test_a_pad_that_falls_as_a_whole_drifts_and_keeps_its_rest() -> None:
    values = noise()
    values[12:] -= 30.0
    assert fall_of(values, 220.0, 1.0, READ) is None
    lowest = values.min(axis=0)
    np.testing.assert_array_equal(resting_with_the_pad(values, lowest, 1.0, READ), lowest)


def test_elements_pressed_in_most_frames_rest_where_the_others_do() -> None:
    for by in (-60.0, 60.0):
        own, rest, sigma = rest_among(pressed(by, slice(8, None)), READ, 0.0)
        assert own[5, 5] == pytest.approx(220.0 + by, abs=1.0)
        assert rest == pytest.approx(np.full(SHAPE, 220.0), abs=1.0)
        assert sigma == pytest.approx(1.0, abs=0.2)
        always = rest_among(pressed(by, slice(None)), READ, 0.0)
        assert always.rest[5, 5] == always.own[5, 5]


def test_elements_that_each_rest_elsewhere_have_no_level_in_common() -> None:
    apart = np.random.default_rng(1).normal(0.0, 40.0, SHAPE)
    assert level_at_rest(noise(), 1.0, READ) == pytest.approx(220.0, abs=0.2)
    assert level_at_rest(noise() + apart, 1.0, READ) is None
    values = pressed(-60.0, slice(8, None)) + apart
    own, rest, _ = rest_among(values, READ, 0.0)
    np.testing.assert_array_equal(rest, own)
