"""``Problem``: everything that the posterior of an outline depends on but the outline itself."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.outline_prior import TURN, WHOLE
from tactile_graph_likelihood.geometry.outlines import Values, period, sizes, unknowns
from tactile_graph_likelihood.single.density.element_terms import States

Places = NDArray[np.int64]

LARGE_PAD = 1024
"""Elements of a pad beyond which strays are many, and noise passes for loads."""


class Problem(NamedTuple):
    """What is asked, what was read, and what is taken for granted.

    Parameters
    ----------
    kind, corners : int
        Of the outline, as in `outlines`.
    grid : ndarray, shape (6,)
        Left and top edge of the first element, pitch and side of an element, in cm; two numbers
        by which a search softens edges, zero otherwise.
    logs, states : ndarray, shape (rows, columns)
        The image, as in `element_terms`.
    noise : ndarray, shape (9,)
        As in `element_terms`.
    estimated : ndarray of int, shape (M,)
        Which of the noise is the point's own instead.
    guess : ndarray, shape (M, 2)
        Mean and standard deviation of each estimated part of the noise.
    prior : ndarray, shape (9,)
        As in `outline_prior`.
    belief, precision : ndarray, shape (D,) and (D, D)
        A normal belief about the outline that multiplies the prior; zeros for none. The caller
        puts its constant, if it matters, into the prior's `EXTRA`.
    """

    kind: int
    corners: int
    grid: Values
    logs: Values
    states: States
    noise: Values
    estimated: Places
    guess: Values
    prior: Values
    belief: Values
    precision: Values


@compiled_as_is
def with_elements(problem: Problem, grid: Values, noise: Values) -> Problem:
    """Return the same problem for another reach of the elements, and other noise."""
    return Problem(
        problem.kind, problem.corners, grid, problem.logs, problem.states, noise,
        problem.estimated, problem.guess, problem.prior, problem.belief, problem.precision,
    )  # fmt: skip


@compiled_as_is
def with_prior(problem: Problem, prior: Values) -> Problem:
    """Return the same problem with another prior."""
    return Problem(
        problem.kind, problem.corners, problem.grid, problem.logs, problem.states, problem.noise,
        problem.estimated, problem.guess, prior, problem.belief, problem.precision,
    )  # fmt: skip


@compiled_as_is
def turned_as(problem: Problem, p: Values) -> Problem:
    """Return the same problem for outlines turned by no more than half a period from a point's."""
    prior = problem.prior.copy()
    if period(problem.kind, problem.corners) > 0.0:
        prior[TURN] = p[2 + sizes(problem.kind)]
    return with_prior(problem, prior)


@compiled_as_is
def over_the_edge(problem: Problem) -> Problem:
    """Return the same problem for outlines that go over the pad's edge, unless they must not.

    Where the edge makes a step in the prior, a search would be caught before it.
    """
    prior = problem.prior.copy()
    prior[WHOLE] = 1.0 if prior[WHOLE] >= 1.0 else 0.0
    return with_prior(problem, prior)


@compiled_as_is
def problem_of(
    kind: int, corners: int, grid: Values, logs: Values, states: States, noise: Values,
    prior: Values,
) -> Problem:  # fmt: skip
    """Return a problem in which the noise is known and nothing else is believed."""
    n = unknowns(kind, corners)
    return Problem(
        kind, corners, grid, logs, states, noise, np.zeros(0, np.int64), np.zeros((0, 2)), prior,
        np.zeros(n), np.zeros((n, n)),
    )  # fmt: skip
