"""At what rate elements reach their load, as loads rise: lognormal gains, and a few strays."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.single.density.element_terms import ROOT_TWO_PI, SPAN

LOWEST, HIGHEST, STEP = -8.0, 16.0, 1.0 / 32.0
"""Of the table, in standard deviations; beyond, the rate is as at its ends."""


@lru_cache(maxsize=32)
def hazards(strays: float, voids: float, sigma: float) -> Values:
    """Return the rate at each place of the table, per standard deviation of ln load.

    Parameters
    ----------
    strays, voids, sigma : float
        As in a noise vector, see `element_terms`.

    Notes
    -----
    Of an element that shows: ``f / (1 - F)`` of ln gain over its standard deviation, where F is
    normal but for the chance of a stray, whose load may be any. Without strays one element that
    reads nonsense would rule an outline out.
    """
    from scipy.special import ndtr

    x = LOWEST + STEP * np.arange(round((HIGHEST - LOWEST) / STEP) + 2)
    own = (1.0 - strays) * (1.0 - voids)
    arrive = own * np.exp(-0.5 * x * x) / ROOT_TWO_PI + strays * sigma / SPAN
    left = own * ndtr(-x) + 0.5 * strays
    table = np.asarray(arrive / left)
    table.setflags(write=False)
    return table


def hazard_parts(strays: float, voids: float) -> Values:
    """Return the table's part that no sigma changes and the strays' for each unit of it, (2, N)."""
    own = hazards(strays, voids, 0.0)
    return np.stack((own, hazards(strays, voids, 1.0) - own))


@compiled_as_is
def hazards_at(parts: Values, sigma: float) -> Values:
    """Return the table at a standard deviation of ln gain, from its parts or from one at it."""
    table: Values = parts[0] + sigma * parts[1] if parts.shape[0] > 1 else parts[0]
    return table


@compiled_as_is
def hazard(table: Values, x: float) -> float:
    """Return the rate at a place, by its neighbours in the table."""
    at = min(max((x - LOWEST) / STEP, 0.0), table.shape[0] - 1.5)
    k = math.floor(at)
    rate: float = table[k] + (at - k) * (table[k + 1] - table[k])
    return rate
