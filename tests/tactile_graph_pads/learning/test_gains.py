"""Gains come out of objects whose load nobody told, and chance is not taken for gains."""

import re

import numpy as np
import pytest

from tactile_graph_pads.learning.gains import gains, spread

SHAPE = (10, 13)


def presses(log_gain, n=200, placement=0.1, seed=0):
    """Return readings of round even faces of any load, and which elements they touch."""
    rng = np.random.default_rng(seed)
    row, column = np.mgrid[: SHAPE[0], : SHAPE[1]]
    at = rng.uniform((0, 0), SHAPE, (n, 2))
    on = np.hypot(row - at[:, :1, None], column - at[:, 1:, None]) < 3.4
    level = rng.uniform(1.0, 5.0, n)[:, None, None]
    read = level * np.exp(log_gain + placement * rng.standard_normal((n, *SHAPE)))
    return np.where(on, read, 0.0), on


def test_gains_are_found_up_to_a_common_factor():
    log_gain = 0.4 * np.random.default_rng(5).standard_normal(SHAPE)
    found = gains(*presses(log_gain), np.ones(SHAPE, bool))
    told = found.gain != 1.0
    assert told.mean() > 0.9
    off = np.log(found.gain[told]) - log_gain[told]
    assert np.std(off) < 0.1
    assert found.stand_out
    assert found.alike > 0.95
    assert found.fixed > 0.85


def test_lines_with_a_gain_are_found():
    log_gain = np.repeat(0.5 * np.random.default_rng(6).standard_normal((SHAPE[0], 1)), SHAPE[1], 1)
    found = gains(*presses(log_gain), np.ones(SHAPE, bool))
    rows = np.log(found.gain).mean(axis=1)
    assert np.corrcoef(rows, log_gain[:, 0])[0, 1] > 0.97


def test_an_even_pad_under_uneven_contact_has_no_gains():
    found = gains(*presses(np.zeros(SHAPE), placement=0.5), np.ones(SHAPE, bool))
    assert not found.stand_out
    assert (found.gain == 1.0).all()
    assert found.sigma == pytest.approx(0.5, rel=0.1)
    assert found.fixed == 0.0


def test_a_bad_element_is_compared_with_nobody():
    log_gain = 0.4 * np.random.default_rng(7).standard_normal(SHAPE)
    readings, on = presses(log_gain)
    good = np.ones(SHAPE, bool)
    good[5, 6] = False
    readings[:, 5, 6] = 1e6
    found = gains(readings, on, good)
    assert found.gain[5, 6] == 1.0
    assert np.std(np.log(found.gain[good]) - log_gain[good]) < 0.15


def test_what_there_is_too_little_of_is_told_and_so_much_more_is_enough():
    log_gain, good = 0.4 * np.random.default_rng(5).standard_normal(SHAPE), np.ones(SHAPE, bool)
    assert gains(*presses(log_gain, 10), good).lacks == "at least 20 are needed"
    readings, on = (np.repeat(part[:1], 40, axis=0) for part in presses(log_gain))
    assert gains(readings, on, good).lacks.startswith("they lie in one place (their centres")
    few = gains(*presses(log_gain, 20), good).lacks
    told = re.fullmatch(r"(\d) of 130 elements lay .* make about (\d+) more that touch .*", few)
    assert told is not None
    assert int(told[1]) < 10
    assert gains(*presses(log_gain, 20 + 2 * int(told[2])), good).lacks == ""
    points = np.eye(130).reshape(130, *SHAPE)
    assert gains(points, points > 0.0, good).lacks.endswith("objects that cover more elements")


def test_nothing_touched_tells_nothing():
    found = gains(np.zeros((5, *SHAPE)), np.zeros((5, *SHAPE), bool), np.ones(SHAPE, bool))
    assert not found.stand_out
    assert (found.gain == 1.0).all()


def test_objects_that_always_lie_in_one_place_tell_no_gains():
    """A foot presses its insole alike at every step: that is the foot's, not the insole's."""
    rng = np.random.default_rng(8)
    row, column = np.mgrid[: SHAPE[0], : SHAPE[1]]
    foot = np.exp(0.5 * rng.standard_normal(SHAPE)) * (np.hypot(row - 5, column - 6) < 4.2)
    readings = (
        foot * rng.uniform(1.0, 4.0, (80, 1, 1)) * np.exp(0.1 * rng.standard_normal((80, *SHAPE)))
    )
    found = gains(readings, readings > 0.0, np.ones(SHAPE, bool))
    assert not found.stand_out
    assert spread(readings) < 0.1 < spread(presses(np.zeros(SHAPE))[0])
