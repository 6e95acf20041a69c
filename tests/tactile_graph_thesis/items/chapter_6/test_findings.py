"""Conclusions on what chapter 6 proposes, and on the heavier side, fail on what refutes them."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph_pads.circuits import Divider
from tactile_graph_thesis.items.chapter_5.section_5_5_2_heavier_side import tells_the_side
from tactile_graph_thesis.items.chapter_6.section_6_1_1_site_isolation import (
    counters,
    fed_back_ratio,
)
from tactile_graph_thesis.items.chapter_6.section_6_1_3_direct_ellipse import (
    less_sensitive,
    no_worse,
)
from tactile_graph_thesis.items.chapter_6.section_6_1_4_restoration import improves


def test_a_circuit_that_leaves_a_tenth_does_not_counter_the_coupling() -> None:
    divider = {4: 20.0, 100: 70.0}
    assert counters(divider, {4: 0.0, 100: 1.0}).holds
    assert not counters(divider, {4: 0.0, 100: 7.0}).holds
    assert not counters({100: 0.0}, {100: 0.0}).holds


def test_rows_fed_what_is_read_leave_the_lone_divider() -> None:
    rng = np.random.default_rng(8)
    siemens = rng.uniform(0.0, 1e-4, (5, 4))
    lone = np.zeros((5, 4))
    lone[2, 1] = siemens[2, 1]
    assert fed_back_ratio(siemens, (2, 1), 33e3) == pytest.approx(Divider().ratio(lone)[2, 1])
    assert 0.0 < Divider().ratio(siemens)[2, 1] < 0.7 * Divider().ratio(lone)[2, 1]
    driven = fed_back_ratio(siemens, (2, 1), 33e3, 1e-3)
    assert driven == pytest.approx(Divider().ratio(lone)[2, 1], rel=1e-5)


def test_an_angle_a_tenth_worse_is_worse() -> None:
    axis = np.array([1.0, np.nan, 3.0])
    assert no_worse(axis, np.array([1.1, np.nan, 3.1])).holds
    assert not no_worse(axis, np.array([1.3, np.nan, 3.2])).holds


@pytest.mark.parametrize(
    ("swept_noisy", "holds"), [(2.3, True), (3.0, False), (2.0, True), (2.6, False)]
)
def test_noise_that_adds_half_as_much_is_still_felt(swept_noisy: float, holds: bool) -> None:
    assert less_sensitive(2.0, 3.0, 2.0, swept_noisy).holds == holds


def test_a_way_that_saves_less_than_a_tenth_is_no_improvement() -> None:
    assert improves({"plain": 1.0, "a": 1.2, "b": 0.85}, "it").holds
    assert not improves({"plain": 1.0, "a": 1.2, "b": 0.95}, "it").holds


def test_sides_that_are_wrong_in_one_of_four_are_not_told() -> None:
    good, bad = np.array([3.0] * 9 + [90.0]), np.array([3.0] * 3 + [90.0])
    assert tells_the_side({1.0: good, 2.0: good}).holds
    assert not tells_the_side({1.0: bad, 2.0: good}).holds
