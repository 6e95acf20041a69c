"""The posterior around its mode, by adaptive importance sampling from few points.

Points fill space evenly and come in blocks, drawn from Student's t around the mean and covariance
that the points before have found, the first around the mode. A new proposal is made whenever the
points have doubled; it ends once they are worth enough equal ones.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.linear import cholesky, inverted, squared_length
from tactile_graph_likelihood.geometry.outlines import (
    DISC,
    ELLIPSE,
    OVAL,
    RECTANGLE,
    Values,
    sizes,
)
from tactile_graph_likelihood.geometry.oval import as_ellipse, log_stretch, to_oval
from tactile_graph_likelihood.single.climbs.maximise import ENOUGH, Mode, maximise
from tactile_graph_likelihood.single.density.element_terms import LEAN_X, ROOT_TWO_PI
from tactile_graph_likelihood.single.density.goodness_of_fit import (
    NO_FIT,
    GoodnessOfFit,
    goodness_of_fit,
)
from tactile_graph_likelihood.single.density.log_posterior import (
    LN_TWO_PI,
    log_likelihood,
    log_rest,
)
from tactile_graph_likelihood.single.density.problem import Problem, over_the_edge, turned_as
from tactile_graph_likelihood.single.sampling.importance import (
    FEWEST,
    KEPT,
    WIDER,
    t_constant,
    t_density,
    temper,
    weigh,
    weighted_moments,
)

SHIFTS = (-1.2, -0.8, -0.4, -0.15, 0.4, 0.8, 1.2)  # of one side, in pitches
FLATTER = 0.5  # power of the likelihood: a side that was moved has not yet settled
HOPELESS, FARTHER = 9.0, 1.4
"""Nats by which a side may be less likely beyond the pad's edge and still be moved on, and by what
factor."""
SURE = 0.85  # probability from which on a side is looked for there: objects mostly lie whole
WIDE = 0.2  # of the mean way squared, added to a proposal's variance: how far is unknown
PROPOSALS = 8
TINY = 1e-9  # cm: no difference of an oval's half axes
FIRST = 1.6  # the first proposal's, over the inverse information: a gap lets an edge slide


class Plan(NamedTuple):
    """How a posterior is sampled.

    ``table`` holds points of Student's t with 8 degrees of freedom, shape (N, K), as `even_points`
    gives them; ``block`` of them are looked at between two looks at how sure the answer is;
    ``worth`` is the number of equal weights at which sampling ends.
    """

    table: Values
    block: int
    worth: float


class Draws(NamedTuple):
    """Points, shape (N, K), their log densities and weights, (N,), their mean and covariance."""

    points: Values
    logs_p: Values
    weights: Values
    mean: Values
    covariance: Values


class Proposals(NamedTuple):
    """Student's t distributions: centres, lower roots, and log densities in the middle.

    ``drawn`` counts the points of each, ``densities`` holds those of each point under each, over
    that in the first one's middle.
    """

    centres: Values
    roots: Values
    levels: Values
    drawn: Values
    densities: Values


class Sample(NamedTuple):
    """A posterior as weighted points; none where no outline is possible.

    ``likeliest`` is the point with the largest density; ``equal_points`` says how many equally
    weighted points they are worth.
    """

    points: Values
    weights: Values
    mean: Values
    covariance: Values
    likeliest: Values
    log_evidence: float
    equal_points: float
    fit: GoodnessOfFit


class Beyond(NamedTuple):
    """Where sides may lie that are beyond the pad's edge, and nobody knows how far.

    ``point`` and ``wider`` are centre, and more variance, of points to be looked at, where sides
    lie there rather than not; ``slack`` the variance of those that may.
    """

    point: Values
    wider: Values
    slack: Values


@compiled_as_is
def log_volume(kind: int, p: Values, root: Values) -> float:
    """Return ln of the volume that a normal mode of a posterior takes, of its own height.

    Parameters
    ----------
    kind, p : int, ndarray
        The mode.
    root : ndarray, shape (K, K)
        Lower root of the information there.
    """
    volume: float = 0.0
    for k in range(p.shape[0]):
        volume += 0.5 * LN_TWO_PI - math.log(root[k, k])
    if kind == OVAL:
        # the mean of 1 / d under a normal distribution, right where it is narrow and in a middle
        spread = inverted(root)
        d2 = p[3] * p[3] + p[4] * p[4] + 0.32 * (spread[3, 3] + spread[4, 4])
        volume -= 0.5 * math.log(d2)
    return volume


@compiled_as_is
def widen_to_other_ends(problem: Problem, mode: Mode, covariance: Values) -> Beyond:
    """Widen a covariance, in place, towards each side's other likely places.

    A void at an end of an outline looks like the end itself.

    Parameters
    ----------
    problem : Problem
    mode : Mode
    covariance : ndarray, shape (K, K)
        Of the posterior around it.

    Returns
    -------
    Beyond
        Where sides may lie that no element says anything of.

    Notes
    -----
    Each side of a rectangle, each end of an ellipse's axes, is moved by itself, by up to 1.2
    pitches. The outer product of each move is added, by the square root of how likely it is. Then
    it is moved on while that is not hopeless. How likely it lies out there follows from the area
    under the posterior along the way, over that of a normal one around the mode.
    """
    kind, p, n = problem.kind, mode.p, mode.p.shape[0]
    beyond = Beyond(p.copy(), np.zeros((n, n)), np.zeros((n, n)))
    if kind not in (RECTANGLE, ELLIPSE, OVAL):
        return beyond
    move, unit, trial = np.zeros(n), np.zeros(n), p.copy()
    for side in range(4):
        place, shift, top = 0, SHIFTS[0], mode.height
        area = mean = square = 0.0
        while True:
            here = _with_side_moved(problem, p, side, shift, move, trial)
            if place < len(SHIFTS):
                _add_outer(covariance, math.exp(FLATTER * min(here - mode.height, 0.0)), move)
                top = max(top, here)
            elif here < top - HOPELESS:
                break
            else:
                part = (1.0 - 1.0 / FARTHER) * shift * math.exp(here - top)
                area += part
                mean += part * shift
                square += part * shift * shift
            for k in range(n):
                unit[k] = move[k] / shift
            place += 1
            shift = SHIFTS[place] if place < len(SHIFTS) else FARTHER * shift
        if area > 0.0:
            chance = area / (area + ROOT_TWO_PI / _length_of(mode.root, unit))
            mean, square = mean / area, square / area
            if chance < SURE:
                _add_outer(beyond.slack, chance * square, unit)
            else:
                _add_outer(beyond.wider, square - mean * mean + WIDE * mean * mean, unit)
                for k in range(n):
                    beyond.point[k] += mean * unit[k]
    return beyond


@compiled_as_is
def beyond_the_pad(problem: Problem, p: Values, root: Values) -> Values:
    """Return the covariance, shape (K, K), by which sides beyond the pad's edge widen a mode.

    ``p`` and ``root`` are of a `Mode`; the covariance of an oval's is an `ELLIPSE`'s.
    """
    near, n = turned_as(problem, p), p.shape[0]
    mode = Mode(p, root, log_rest(near, p) + log_likelihood(near, p))
    beyond = widen_to_other_ends(near, mode, np.zeros((n, n)))
    found = beyond.slack + beyond.wider
    _add_outer(found, 1.0, beyond.point - p)
    if problem.kind == OVAL:
        turn, d = np.eye(n), max(math.hypot(p[3], p[4]), TINY)
        turn[2, 3], turn[2, 4] = p[3] / d, p[4] / d
        turn[3, 2], turn[3, 3], turn[3, 4] = 1.0, -p[3] / d, -p[4] / d
        turn[4, 3], turn[4, 4] = -0.5 * p[4] / (d * d), 0.5 * p[3] / (d * d)
        found = turn @ found @ turn.T
    return found


@compiled_as_is
def _length_of(root: Values, move: Values) -> float:
    """Return a move's length in standard deviations, all else held."""
    squared = 0.0
    for k in range(move.shape[0]):
        along = 0.0
        for m in range(k, move.shape[0]):
            along += root[m, k] * move[m]
        squared += along * along
    return math.sqrt(squared)


@compiled_as_is
def _add_outer(matrix: Values, share: float, move: Values) -> None:
    """Add a share of a vector's outer product with itself to the first rows and columns."""
    for k in range(move.shape[0]):
        for m in range(move.shape[0]):
            matrix[k, m] += share * move[k] * move[m]


@compiled_as_is
def _with_side_moved(
    problem: Problem, p: Values, side: int, shift: float, move: Values, trial: Values
) -> float:
    """Return the log posterior with a side moved outwards by pitches; write move and point."""
    kind = problem.kind
    at = as_ellipse(p) if kind == OVAL else p
    axis, half = side // 2, 0.5 * shift * problem.grid[2]
    way = 1.0 if side % 2 == 0 else -1.0
    turn = at[4] + 0.5 * math.pi * axis
    trial[0] = at[0] + way * half * math.cos(turn)
    trial[1] = at[1] - way * half * math.sin(turn)
    trial[2], trial[3] = at[2] + half * (1 - axis), at[3] + half * axis
    trial[4] = at[4]
    _lean_on(problem, p, at, axis, way * half * (1 - 2 * axis), trial)
    if kind == OVAL:
        to_oval(trial)
    for k in range(p.shape[0]):
        move[k] = trial[k] - p[k]
    here = log_rest(problem, trial)
    if here > -math.inf:
        here += log_likelihood(problem, trial)
    return here


@compiled_as_is
def _lean_on(
    problem: Problem, p: Values, at: Values, axis: int, shift_cm: float, trial: Values
) -> None:
    """Write load and lean of an outline that is moved along an axis, so that none change on it.

    The load is that of the centre, and a lean goes over half the outline's extent.
    """
    for k in range(5, p.shape[0]):
        trial[k] = p[k]
    for k in range(problem.estimated.shape[0]):
        if problem.estimated[k] != LEAN_X:
            continue
        cos, sin = math.cos(at[4]), math.sin(at[4])
        leans = np.array([p[6 + k] * cos - p[7 + k] * sin, p[6 + k] * sin + p[7 + k] * cos])
        trial[5] += leans[axis] * shift_cm / at[2 + axis]
        leans[axis] *= trial[2 + axis] / at[2 + axis]
        trial[6 + k] = leans[0] * cos + leans[1] * sin
        trial[7 + k] = leans[1] * cos - leans[0] * sin


@compiled_as_is
def no_draws(count: int, n: int) -> Draws:
    """Return space for so many points of so many numbers each."""
    return Draws(
        np.empty((count, n)), np.empty(count), np.empty(count), np.empty(n), np.empty((n, n))
    )


@compiled_as_is
def no_proposals(most: int, n: int, points: int) -> Proposals:
    """Return space for so many proposals of so many numbers each, and for points."""
    return Proposals(
        np.empty((most, n)), np.zeros((most, n, n)), np.empty(most), np.zeros(most),
        np.empty((most, points)),
    )  # fmt: skip


@compiled_as_is
def propose(proposals: Proposals, k: int, centre: Values, covariance: Values) -> bool:
    """Write a proposal; return whether its covariance is positive."""
    root = proposals.roots[k]
    if not cholesky(covariance, root):
        return False
    proposals.levels[k] = 0.0
    for i in range(centre.shape[0]):
        proposals.centres[k, i] = centre[i]
        proposals.levels[k] -= math.log(root[i, i])
    return True


@compiled_as_is
def draw(proposals: Proposals, k: int, step: Values, point: Values) -> None:
    """Write the point of a proposal that a step of standard Student's t leads to."""
    for i in range(point.shape[0]):
        place = proposals.centres[k, i]
        for m in range(i + 1):
            place += proposals.roots[k, i, m] * step[m]
        point[i] = place


@compiled_as_is
def _add_densities(proposals: Proposals, k: int, points: Values, first: int, last: int) -> None:
    """Write the densities of some points under a proposal."""
    n = points.shape[1]
    off, work = np.empty(n), np.empty(n)
    level = math.exp(proposals.levels[k] - proposals.levels[0])
    for i in range(first, last):
        for m in range(n):
            off[m] = points[i, m] - proposals.centres[k, m]
        far = squared_length(proposals.roots[k], off, work)
        proposals.densities[k, i] = level * t_density(far, n)


@compiled_as_is
def take_block(
    proposals: Proposals, made: int, points: Values, before: int, count: int, block: int
) -> None:
    """Count a block of points as drawn from the last proposal, and write their densities.

    Parameters
    ----------
    proposals : Proposals
        Written.
    made : int
        How many there are.
    points : ndarray, shape (N, K)
    before : int
        Points whose densities under the last proposal are known.
    count, block : int
        Points before the block, and in it.
    """
    proposals.drawn[made - 1] += block
    for c in range(made):
        _add_densities(proposals, c, points, before if c == made - 1 else count, count + block)


@compiled_as_is
def log_evidence_of(proposals: Proposals, mean_weight: float, n: int) -> float:
    """Return the log evidence, given the logarithm of the mean of n numbers' weights."""
    evidence: float = mean_weight - proposals.levels[0] - t_constant(n)
    return evidence


@compiled_as_is
def next_covariance(draws: Draws, count: int, first: Values, centre: Values) -> Values:
    """Return the covariance of the next proposal, and write its centre."""
    tempered, found = np.empty(count), np.empty(first.shape)
    temper(draws.weights, count, FEWEST * centre.shape[0], tempered)
    weighted_moments(draws.points, tempered, count, centre, found)
    return WIDER * found + KEPT * first


@compiled_as_is
def importance_sample(
    problem: Problem, plan: Plan, mode: Values, covariance: Values, beyond: Beyond, draws: Draws
) -> tuple[int, float, float]:
    """Sample the posterior around its mode.

    Parameters
    ----------
    problem : Problem
    plan : Plan
    mode, covariance : ndarray, shape (K,) and (K, K)
        Of the first proposal; it is drawn wider.
    beyond : Beyond
        Where the second proposal is made, if sides lie there rather than not.
    draws : Draws
        Written.

    Returns
    -------
    (int, float, float)
        Points used, log evidence, number of equal weights; -inf and 0 if no point is possible.
    """
    kind, n, most, block = problem.kind, mode.shape[0], plan.table.shape[0], plan.block
    proposals = no_proposals(PROPOSALS, n, most)
    centre, wanted = mode.copy(), FIRST * covariance
    draws.mean[:] = mode
    least = block * (1 if kind == DISC else 2 if kind == OVAL else 4)
    far = beyond.wider[0, 0] + beyond.wider[1, 1] > 0.0
    if far:
        least *= 2
    count, made, renewed, evidence, equal = 0, 0, 0, -math.inf, 0.0
    while count + block <= most:
        before = count
        if made == 0 or (count >= 2 * renewed and made < PROPOSALS):
            if made == 1 and far:
                centre[:] = beyond.point
                wanted += beyond.wider
            elif made > 0:
                wanted = next_covariance(draws, count, covariance, centre)
            if not propose(proposals, made, centre, wanted):
                break
            renewed, before = count, 0
            made += 1
        for i in range(count, count + block):
            draw(proposals, made - 1, plan.table[i], draws.points[i])
            here = log_rest(problem, draws.points[i])
            if here > -math.inf:
                here += log_likelihood(problem, draws.points[i])
                if kind == OVAL:
                    here += log_stretch(draws.points[i])
            draws.logs_p[i] = here
        take_block(proposals, made, draws.points, before, count, block)
        count += block
        if count < least and count < 2 * renewed:
            continue
        evidence, equal = weigh(
            draws.logs_p, proposals.densities, proposals.drawn / count, made, count, draws.weights
        )
        if equal <= 0.0 or (equal >= plan.worth and count >= least):
            break
    if equal > 0.0:
        weighted_moments(draws.points, draws.weights, count, draws.mean, draws.covariance)
    return count, log_evidence_of(proposals, evidence, n), equal


@compiled_as_is
def sample_around(
    problem: Problem, table: Values, block: int, worth: float, loose: float, p: Values,
    root: Values, height: float,
) -> Sample:  # fmt: skip
    """Return the posterior around a mode.

    Parameters
    ----------
    problem : Problem
    table, block, worth
        Of the `Plan`: handing over more than one record costs 15 us.
    loose : float
        Variance in cm^2 that is added to each length where it is first looked for.
    p, root, height
        Of the `Mode`. A height of -inf is that of a point near the top, which is looked for as if
        there were no more pad beyond its edge than before it; ``p`` and ``root`` are written.
    """
    if height == -math.inf:
        maximise(over_the_edge(problem), p, root, ENOUGH, math.inf)
    plan, kind, n, count = Plan(table, block, worth), problem.kind, p.shape[0], table.shape[0]
    near = turned_as(problem, p)
    # the search may have been told another noise, and another prior beyond the pad's edge
    mode = Mode(p, root, log_rest(near, p) + log_likelihood(near, p))
    draws = no_draws(count, n)
    covariance = inverted(mode.root)
    for k in range(2 + sizes(kind)):
        covariance[k, k] += loose
    beyond = widen_to_other_ends(near, mode, covariance)
    used, evidence, equal = importance_sample(near, plan, mode.p, covariance, beyond, draws)
    fit = NO_FIT
    if equal <= 0.0:
        used = 0
    else:
        draws.covariance[:, :] += beyond.slack
        fit = goodness_of_fit(problem, draws.mean)
    likeliest, top = mode.p.copy(), mode.height
    if kind == OVAL:
        top += log_stretch(mode.p)
    for i in range(used):
        if draws.logs_p[i] > top:
            top = draws.logs_p[i]
            likeliest[:] = draws.points[i]
    return Sample(
        draws.points[:used], draws.weights[:used], draws.mean, draws.covariance, likeliest,
        evidence, equal, fit,
    )  # fmt: skip
