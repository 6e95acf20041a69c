"""Whether an image looks like the model's at all, given the load expected on each element."""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.single.element_terms import (
    LEAST,
    ON,
    ROOT_TWO_PI,
    SIGMA,
    SPAN,
    SQRT_HALF,
    STRAYS,
    UNKNOWN,
    VOIDS,
    States,
)
from tactile_graph_likelihood.single.misfit import DENSITY, SURE, moments_of_strays, moments_of_term


@compiled_as_is
def misfit_of_load(
    expected: Values, fitted: int, logs: Values, states: States, noise: Values
) -> tuple[float, float]:
    """Return how surprising an image is, and how much neighbours' gains are alike.

    Parameters
    ----------
    expected : ndarray, shape (rows, columns)
        Load expected on each element, of all outlines together.
    fitted : int
        How many numbers were fitted.
    logs, states, noise
        As in `element_terms.terms`.

    Returns
    -------
    (float, float)
        As of `misfit.misfit`, but of the patterns only how alike neighbours are, not over the
        residuals' own variance.
    """
    rows, cols = states.shape
    sigma, present, strays = noise[SIGMA], 1.0 - noise[VOIDS], noise[STRAYS]
    level = math.log((1.0 - strays) * present / (sigma * ROOT_TWO_PI))
    stray, bare = math.log(strays / SPAN), math.log(1.0 - strays)
    mean_bare, var_bare = moments_of_strays(strays)
    got = mean = variance = pairs = product = 0.0
    residuals = np.zeros((rows + 1, cols + 1))
    for i in range(rows):
        for j in range(cols):
            on = states[i, j] == ON
            if states[i, j] == UNKNOWN:
                continue
            if expected[i, j] <= 0.0:
                got += stray if on else bare
                mean += mean_bare
                variance += var_bare
                continue
            mu = math.log(expected[i, j])
            z = min(max((mu - noise[LEAST]) / sigma, -40.0), 40.0)
            tail, density = 0.5 * math.erfc(-SQRT_HALF * z), DENSITY * math.exp(-0.5 * z * z)
            off, one, spread = moments_of_term(z, tail, density, level, present, bare)
            if on:
                u = (logs[i, j] - mu) / sigma
                got += math.log(math.exp(level - 0.5 * u * u) + strays / SPAN)
                residuals[i, j] = u if z > SURE else 0.0
            else:
                got += off
            mean += one
            variance += spread
    for i in range(rows):
        for j in range(cols):
            for other in (residuals[i + 1, j], residuals[i, j + 1]):
                if residuals[i, j] != 0.0 and other != 0.0:
                    pairs += 1.0
                    product += residuals[i, j] * other
    alike = product / math.sqrt(pairs) if pairs > 0.0 else 0.0
    return (got - 0.5 * fitted - mean) / math.sqrt(variance), alike
