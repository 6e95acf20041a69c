"""Whether what one long outline covers is rather two round objects that touch: by their waist.

On either side of where two discs touch nothing bears a load. An outline around both covers that,
and takes what reads little or nothing there for chance.
"""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.compiled import compiled_as_is, compiled_later
from tactile_graph_likelihood.geometry.covered import Box, covered, window
from tactile_graph_likelihood.geometry.outlines import DISC, OVAL, Values
from tactile_graph_likelihood.geometry.oval import as_ellipse
from tactile_graph_likelihood.single.density.element_terms import CONTRAST, ON, terms
from tactile_graph_likelihood.single.density.log_posterior import log_likelihood, noise_at
from tactile_graph_likelihood.single.density.problem import Problem

LONG, LONGEST = 1.35, 3.0
"""Length over breadth between which an outline may be two discs: around touching ones it is 1.4 to
2.6."""

SPLITS = (0.5, 0.42, 0.58)
"""Of the length, what is the first disc's where a search begins."""

HOPELESS, UTTERLY = 25.0, 60.0
"""Nats by which two discs are behind one outline at first from which on none are searched for, and
not even looked at with another split."""

FIRST, LAST, GAINED = 0.25, 0.05, 0.1
"""Steps of the search in pitches, and nats for which another round is worth its time."""

CLEARLY = 0.5
"""Share of an element from which on it tells the load of the disc that covers it."""

SMALLEST = 0.5
"""Radius of a disc in pitches."""

_DISC, _OVAL = DISC, OVAL


@compiled_later
def gain_by_two(problem: Problem, p: Values) -> float:
    """Return by how much readings are likelier under two discs that touch than under one outline.

    Parameters
    ----------
    problem : Problem
        Of an ellipse or a rectangle with an even face.
    p : ndarray, shape (K,)
        As in `log_likelihood`: a most likely point.

    Returns
    -------
    float
        In nats; ``-inf`` where the outline is not as long as two discs.

    Notes
    -----
    The discs are as many numbers as an outline and a load, but for one: places, radii and two loads
    less that they touch. They are looked for from the outline's ends, one number after another.
    """
    its = as_ellipse(p) if problem.kind == _OVAL else p
    half, short, angle = its[2], its[3], its[4]
    if short > half:
        half, short, angle = short, half, angle + 0.5 * math.pi
    if half < LONG * short or half > LONGEST * short:
        return -math.inf
    grid, noise, states = problem.grid, noise_at(problem, p), problem.states
    margin = grid[2] + max(max(SPLITS) * half - short, 0.0)
    box = window(problem.kind, 0, p, grid, states.shape[0], states.shape[1], margin)
    one = log_likelihood(problem, p)
    two, best = np.empty(5), -math.inf
    for split in SPLITS:
        trial = np.array([its[0], its[1], angle, split * half, (1.0 - split) * half])
        found = _log_likelihood_of_two(problem, trial, noise, box)
        if found > best:
            two, best = trial, found
        if best < one - UTTERLY:
            break
    if best > one - HOPELESS:
        best = _searched(problem, two, best, noise, box)
    return best - one


@compiled_as_is
def _searched(problem: Problem, two: Values, best: float, noise: Values, box: Box) -> float:
    """Bring two discs, in place, nearer to the top of their log likelihood, and return that."""
    step, trial = FIRST * problem.grid[2], np.empty(5)
    while step >= LAST * problem.grid[2]:
        before = best
        for k in range(5):
            along = step / (two[3] + two[4]) if k == 2 else step
            for way in (-1.0, 1.0):
                trial[:] = two
                trial[k] += way * along
                found = _log_likelihood_of_two(problem, trial, noise, box)
                if found > best:
                    best = found
                    two[:] = trial
                    break
        if best < before + GAINED:
            step *= 0.5
    return best


@compiled_as_is
def _log_likelihood_of_two(problem: Problem, two: Values, noise: Values, box: Box) -> float:
    """Return the log likelihood of two touching discs, each of the load that its elements read.

    ``two`` is the middle of their length, its direction, and both radii.
    """
    grid = problem.grid
    if min(two[3], two[4]) < SMALLEST * grid[2]:
        return -math.inf
    cos, sin = math.cos(two[2]), math.sin(two[2])
    first = np.array([two[0] - two[4] * cos, two[1] + two[4] * sin, two[3]])
    second = np.array([two[0] + two[3] * cos, two[1] - two[3] * sin, two[4]])
    shares, others = covered(_DISC, 0, first, grid, box), covered(_DISC, 0, second, grid, box)
    load = _load_on(problem, shares, noise, box)
    other = _load_on(problem, others, noise, box)
    if load == -math.inf or other == -math.inf:
        return -math.inf
    shares += math.exp((other - load) / noise[CONTRAST]) * others
    return terms(shares, load, box[0], box[1], problem.logs, problem.states, noise)


@compiled_as_is
def _load_on(problem: Problem, shares: Values, noise: Values, box: Box) -> float:
    """Return the mean logarithm of a covered element's load, ``-inf`` where none is seen."""
    total, count = 0.0, 0
    for i in range(box[2]):
        for j in range(box[3]):
            if shares[i, j] >= CLEARLY and problem.states[box[0] + i, box[1] + j] == ON:
                reads = problem.logs[box[0] + i, box[1] + j]
                total += reads - noise[CONTRAST] * math.log(shares[i, j])
                count += 1
    return total / count if count > 0 else -math.inf
