"""Outlines brought to their joint mode, and the evidence there."""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.linear import cholesky, solved
from tactile_graph_likelihood.geometry.outline_prior import pulled_in
from tactile_graph_likelihood.geometry.outlines import Values, sizes, unknowns
from tactile_graph_likelihood.several.joint.joint_posterior import (
    MIDDLE,
    SPREAD,
    WIDTH,
    JointProblem,
    Outlines,
    gain,
    lightest,
    log_rest_of,
    slopes,
    smallest,
)
from tactile_graph_likelihood.single.climbs.maximise import soft_and_strict
from tactile_graph_likelihood.single.density.information import STEP, Information, steps_of

HALVINGS = 6
LOOSE, GAP = 0.01, 6.0
"""Information, per squared pitch, that is added to each number's own: to keep steps finite;
for the evidence, since an edge that lies in a gap may slide, but no farther than the gap."""
HALF_LN_TWO_PI = 0.5 * math.log(2.0 * math.pi)


@compiled_as_is
def add_rest(problem: JointProblem, outlines: Outlines, loose: float, out: Information) -> None:
    """Add what is known beforehand, and a little that keeps the information invertible."""
    kinds, corners, points = outlines
    grid, prior, (slope, matrix) = problem.grid, problem.prior, out
    for k in range(kinds.shape[0]):
        kind, first, at = kinds[k], unknowns(kinds[k], corners[k]), k * WIDTH
        for m in range(2, 2 + sizes(kind)):
            slope[at + m] -= 1.0 / points[k, m]
        steps = steps_of(kind, corners[k], points[k], grid)
        for m in range(first):
            matrix[at + m, at + m] += loose / (steps[m] / STEP) ** 2
        sure = 1.0 / (prior[SPREAD] * prior[SPREAD])
        slope[at + first] -= sure * (points[k, first] - prior[MIDDLE])
        matrix[at + first, at + first] += sure


@compiled_as_is
def _pulled_in(kind: int, corners: int, p: Values, noise: Values, prior: Values) -> None:
    """Bring an outline and its load, in place, to where its prior is not zero."""
    pulled_in(kind, corners, p, prior)
    at = unknowns(kind, corners)
    p[at] = max(p[at], lightest(noise))
    p[2] = max(p[2], 1.001 * smallest(kind, corners, prior))


@compiled_as_is
def log_posterior(problem: JointProblem, outlines: Outlines) -> float:
    """Return the log posterior of outlines given others, -inf where their prior is zero."""
    total = log_rest_of(problem, outlines)
    if total > -math.inf:
        total += gain(problem, outlines)
    return total


@compiled_as_is
def with_slopes(problem: JointProblem, outlines: Outlines, out: Information) -> float:
    """Return `log_posterior`; write slope and information of the readings alone."""
    return log_rest_of(problem, outlines) + slopes(problem, outlines, out)


@compiled_as_is
def maximise_jointly(
    problem: JointProblem, outlines: Outlines, most: int, enough: float, out: Information
) -> float:
    """Bring outlines, in place, to the top of their log posterior given others; return it.

    Parameters
    ----------
    problem : JointProblem
    outlines : Outlines
        Written.
    most : int
        Rounds.
    enough : float
        Gain in log posterior still promised, below which the search ends.
    out : Information
        Written: what `slopes` does, where the outlines end.
    """
    kinds, corners, points = outlines
    noise, prior = problem.noise, problem.prior
    size = kinds.shape[0] * WIDTH
    step, root = np.empty(size), np.empty((size, size))
    all_in = Information(np.empty(size), np.empty((size, size)))
    ahead = Information(np.empty(size), np.empty((size, size)))
    for k in range(kinds.shape[0] if most > 0 else 0):
        _pulled_in(kinds[k], corners[k], points[k], noise, prior)
    trial = points.copy()
    tried = Outlines(kinds, corners, trial)
    now = with_slopes(problem, outlines, out)
    damping = 0.0
    for _ in range(most):
        _take(out, all_in)
        add_rest(problem, outlines, LOOSE, all_in)
        for k in range(size):
            all_in.matrix[k, k] *= 1.0 + damping
        if not cholesky(all_in.matrix, root):
            return now
        solved(root, all_in.slope, step)
        promised = 0.0
        for k in range(size):
            promised += all_in.slope[k] * step[k]
        if promised < enough:
            return now
        part, new = 1.0, -math.inf
        for _ in range(HALVINGS):
            for k in range(kinds.shape[0]):
                for m in range(WIDTH):
                    trial[k, m] = points[k, m] + part * step[k * WIDTH + m]
                _pulled_in(kinds[k], corners[k], trial[k], noise, prior)
            if part == 1.0:  # mostly the next point: a second look would cost more
                new = with_slopes(problem, tried, ahead)
            else:
                new = log_posterior(problem, tried)
            if new > now:
                break
            part *= 0.4
        if not new > now:
            if damping > 50.0:
                return now
            damping = max(1.0, 10.0 * damping)
            continue
        gained, now = new - now, new
        for x in range(size):
            points[x // WIDTH, x % WIDTH] = trial[x // WIDTH, x % WIDTH]
        if part < 1.0:
            slopes(problem, outlines, ahead)
        _take(ahead, out)
        damping = 0.0 if part == 1.0 else 0.3
        if gained < 0.5 * enough:
            return now
    return now


@compiled_as_is
def _take(its: Information, out: Information) -> None:
    """Write one information into another."""
    for x in range(its.slope.shape[0]):
        out.slope[x] = its.slope[x]
        for y in range(its.slope.shape[0]):
            out.matrix[x, y] = its.matrix[x, y]


@compiled_as_is
def likeliest_of(problem: JointProblem, kind: int, corners: int, points: Values) -> int:
    """Return which of some outlines of a kind, each by itself, has the highest log posterior.

    ``points`` has shape (N, 6); the first of those that are equal.
    """
    best, most = 0, -math.inf
    kinds, edges = np.full(1, kind, np.int64), np.full(1, corners, np.int64)
    for n in range(points.shape[0]):
        now = log_posterior(problem, Outlines(kinds, edges, points[n : n + 1]))
        if now > most:
            best, most = n, now
    return best


@compiled_as_is
def softened(problem: JointProblem) -> JointProblem:
    """Return a problem whose elements feel a little beyond their edge, and that knows no strays."""
    soft, strict = soft_and_strict(problem.grid, problem.noise)
    return JointProblem(
        soft, problem.logs, problem.states, strict, problem.prior, problem.load, problem.share
    )


@compiled_as_is
def laplace_evidence(
    problem: JointProblem, outlines: Outlines, total: float, out: Information
) -> float:
    """Return the log evidence around a mode by Laplace's method.

    ``total`` is the log posterior at the mode, ``out`` what `slopes` writes there; what is known
    beforehand is added to it.
    """
    kinds, corners, points = outlines
    noise, prior, (slope, matrix) = problem.noise, problem.prior, out
    if total == -math.inf:
        return total
    add_rest(problem, outlines, GAP, out)
    root = np.empty(matrix.shape)
    if not cholesky(matrix, root):
        return -math.inf
    for k in range(kinds.shape[0]):
        total += HALF_LN_TWO_PI * (unknowns(kinds[k], corners[k]) + 1)
    for k in range(matrix.shape[0]):
        total -= math.log(root[k, k])
    for k in range(kinds.shape[0]):
        for m in range(2, 2 + sizes(kinds[k])):
            if points[k, m] < 1.002 * smallest(kinds[k], corners[k], prior):
                at = k * WIDTH + m
                total += _log_of_part(-slope[at] / math.sqrt(matrix[at, at]))
        if points[k, unknowns(kinds[k], corners[k])] < lightest(noise) + 1e-3:
            at = k * WIDTH + unknowns(kinds[k], corners[k])
            total += _log_of_part(-slope[at] / math.sqrt(matrix[at, at]))
    return total


@compiled_as_is
def settle(
    problem: JointProblem, outlines: Outlines, soft: int, most: int, enough: float, matrix: Values
) -> float:
    """Bring outlines to their joint mode, in ``most`` rounds, and return the log evidence there.

    With no rounds they stay where they are. At first the problem is `softened`, for ``soft``
    rounds. The information is written to ``matrix``.
    """
    now, stages = -math.inf, (softened(problem), problem)
    out = Information(np.empty(matrix.shape[0]), matrix)
    for stage in range(0 if soft > 0 else 1, 2):  # one call, which is compiled once
        rounds, least = (soft, 0.5) if stage == 0 else (most, enough)
        now = maximise_jointly(stages[stage], outlines, rounds, least, out)
    return laplace_evidence(problem, outlines, now, out)


@compiled_as_is
def _log_of_part(fall: float) -> float:
    """Return the log of what a bound leaves of a normal density's mass, its top at the bound.

    ``fall`` is the slope away from the bound in standard deviations: the mass of
    exp(-fall x - x**2 / 2) over x > 0, over that of the whole normal density.
    """
    if fall > 25.0:
        return -math.log(fall * math.sqrt(2.0 * math.pi))
    if fall < -5.0:
        return 0.0
    return 0.5 * fall * fall + math.log(0.5 * math.erfc(fall * math.sqrt(0.5)))
