"""Hysteresis: what an element keeps, and conclusions that fail on what refutes them."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph_pads.law import ForceLaw
from tactile_graph_thesis.items.chapter_2.section_2_1_2_hysteresis import (
    CASES,
    Read,
    at_rest,
    moved,
    retained_g,
)

NONE = Read(volts=20.0, centre_cm=0.4, radius_cm=0.3)


def test_an_element_keeps_its_share_of_what_it_gained_under_more_load() -> None:
    law = ForceLaw()
    loads, most = np.array([[0.0, 100.0, 100.0]]), np.array([[100.0, 200.0, 50.0]])
    seems = law.conductance_s(retained_g(law, loads, most, 0.1))
    now, then = law.conductance_s(loads), law.conductance_s(most)
    wanted = [0.1 * then[0, 0], 0.9 * now[0, 1] + 0.1 * then[0, 1], now[0, 2]]
    np.testing.assert_allclose(seems[0], wanted, rtol=1e-12)


def test_the_cases_are_those_that_are_told() -> None:
    assert {name: tuple(case) for name, case in CASES.items()} == {
        "no hysteresis": (0.0, 1.0, 0.0),
        "put down": (0.1, 1.3, 0.0),
        "slid": (0.1, 1.0, 2.6),
    }


@pytest.mark.parametrize(
    ("other", "little"),
    [
        (NONE, True),
        (Read(21.9, 0.43, 0.28), True),
        (Read(22.1, 0.4, 0.3), False),
        (Read(20.0, 0.45, 0.3), False),
        (Read(20.0, 0.4, 0.26), False),
    ],
)
def test_a_tenth_of_readings_or_of_an_error_matters(other: Read, little: bool) -> None:
    assert at_rest(NONE, other).holds == little
    assert moved(NONE, other).holds != little
