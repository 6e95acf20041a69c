"""Likely shapes are equal where shape and posterior are."""

from __future__ import annotations

import pickle
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from tactile_graph import Circle
from tactile_graph_likelihood.geometry.outlines import DISC, RECTANGLE
from tactile_graph_likelihood.single.likely import likely
from tactile_graph_likelihood.single.posterior import Posterior


def posterior(kind: int, corners: int, *mean: float) -> Posterior:
    n = len(mean)
    points = np.array([mean, mean])
    weights = np.array([0.5, 0.5])
    return Posterior(
        kind,
        corners,
        np.array(mean),
        np.eye(n),
        points,
        weights,
        np.array(mean),
        1.0,
        2.0,
        0.0,
        0.0,
    )


@pytest.mark.parametrize(
    "given", [(DISC, 0, 3.0, 4.0, 2.0), (RECTANGLE, 4, 3.0, 4.0, 2.0, 1.0, 0.1)]
)
def test_shapes_of_different_uncertainty_are_not_equal(given: Any) -> None:
    one = likely(posterior(*given))
    copied = pickle.loads(pickle.dumps(one))
    assert one == copied
    assert hash(one) == hash(copied)
    assert one != replace(one, posterior=None)  # type: ignore[arg-type]
    assert one != replace(one, posterior=replace(one.posterior, covariance=2.0 * np.eye(9)))
    assert one != replace(one, posterior=replace(one.posterior, surprise=1.0))


def test_a_likely_circle_is_no_bare_one() -> None:
    assert likely(posterior(DISC, 0, 3.0, 4.0, 2.0)) != Circle(3.0, 4.0, 2.0)
