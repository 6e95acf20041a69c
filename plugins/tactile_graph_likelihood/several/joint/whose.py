"""Whose each touched element is, by outlines, and what none of them explains."""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.several.joint.joint_posterior import JointProblem, Outlines, lay
from tactile_graph_likelihood.single.density.element_terms import (
    LEAST,
    ON,
    SIGMA,
    SQRT_HALF,
    UNKNOWN,
    VOIDS,
    on_level,
)
from tactile_graph_likelihood.single.density.problem import Places

ODD = 2.0
"""Half the squared residual, in sigmas, from which on a reading counts as not explained."""

USUAL = 0.1307
"""Mean of what a reading leaves unexplained, were the model true."""

NEAR = 2
"""Cells within which an element that no outline covers may be one's."""


@compiled_as_is
def unexplained_by(problem: JointProblem, load: Values, less_usual: bool) -> Values:
    """Return what a load leaves unexplained of each reading, in nats, shape (rows, columns).

    Less what a load that is true would leave in the mean, where that is asked for.
    """
    states, noise = problem.states, problem.noise
    most, found = on_level(noise), np.zeros(load.shape)
    for i in range(load.shape[0]):
        for j in range(load.shape[1]):
            if states[i, j] == UNKNOWN:
                continue
            mu = math.log(max(load[i, j], 1e-9))
            z = (mu - noise[LEAST]) / noise[SIGMA]
            shows = (1.0 - noise[VOIDS]) * 0.5 * math.erfc(-SQRT_HALF * z)
            if states[i, j] == ON:
                half = 0.5 * ((problem.logs[i, j] - mu) / noise[SIGMA]) ** 2
                found[i, j] = min(half, most) if half > ODD else 0.0
            else:
                found[i, j] = -math.log1p(-shows)
            if less_usual:
                found[i, j] -= shows * USUAL - (1.0 - shows) * math.log1p(-shows)
    return found


@compiled_as_is
def whose_by_outlines(problem: JointProblem, outlines: Outlines) -> tuple[Places, Values]:
    """Return which outline each touched element belongs to, and what is unexplained.

    Returns
    -------
    own : ndarray of int64, shape (rows, columns)
        The number, from 0, of the outline that brings most to a touched element, or the nearest
        one's within two cells; -1 of others.
    unexplained : ndarray, shape (rows, columns)
        As of `unexplained_by`.
    """
    states = problem.states
    rows, cols = states.shape
    own = np.full((rows, cols), -1, np.int64)
    most, total = np.zeros((rows, cols)), np.zeros((rows, cols))
    here, share = np.empty((rows, cols)), np.zeros((rows, cols))
    for k in range(outlines.kinds.shape[0]):
        here[:, :] = 0.0
        lay(problem, outlines, k, 0, 0, here, share)
        for i in range(rows):
            for j in range(cols):
                total[i, j] += here[i, j]
                if here[i, j] > most[i, j] and states[i, j] == ON:
                    own[i, j], most[i, j] = k, here[i, j]
    for i in range(rows):
        for j in range(cols):
            if states[i, j] == ON and own[i, j] < 0:
                own[i, j] = _nearest(own, i, j)
    return own, unexplained_by(problem, total, False)


@compiled_as_is
def _nearest(own: Places, row: int, column: int) -> int:
    """Return whose the nearest element is that is somebody's, -1 where none is near."""
    found, far = -1, NEAR + 1
    for i in range(max(row - NEAR, 0), min(row + NEAR + 1, own.shape[0])):
        for j in range(max(column - NEAR, 0), min(column + NEAR + 1, own.shape[1])):
            off = max(abs(i - row), abs(j - column))
            if own[i, j] >= 0 and off < far:
                found, far = own[i, j], off
    return found
