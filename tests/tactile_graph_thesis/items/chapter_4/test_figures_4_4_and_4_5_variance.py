"""Variances of rising numbers of readings."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph_thesis.items.chapter_4.figures_4_4_and_4_5_variance import running_variances


def test_running_variances_are_those_of_the_first_readings() -> None:
    errors = np.random.default_rng(0).normal(size=(2, 23))
    found = running_variances(errors, 10)
    assert found.shape == (2, 2, 9)
    for k in range(2, 11):
        expected = errors[1, 10 : 10 + k].var(ddof=1)
        assert found[1, 1, k - 2] == pytest.approx(expected)
