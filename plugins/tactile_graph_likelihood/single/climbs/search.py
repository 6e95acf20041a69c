"""From an image to the mode of the posterior: where the search begins, and its attempts.

It begins with an outline that has the moments of the touched elements.
"""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.lengths import length
from tactile_graph_likelihood.geometry.outline_prior import pulled_in
from tactile_graph_likelihood.geometry.outlines import (
    DISC,
    ELLIPSE,
    OVAL,
    RECTANGLE,
    REGULAR,
    Values,
    period,
    sizes,
    unknowns,
)
from tactile_graph_likelihood.geometry.oval import to_oval
from tactile_graph_likelihood.single.climbs.maximise import ENOUGH, ROUGH, maximise, softened
from tactile_graph_likelihood.single.density.element_terms import ON, OVER, States
from tactile_graph_likelihood.single.density.goodness_of_fit import (
    NO_FIT,
    GoodnessOfFit,
    goodness_of_fit,
)
from tactile_graph_likelihood.single.density.log_posterior import log_likelihood, log_rest
from tactile_graph_likelihood.single.density.problem import Problem
from tactile_graph_likelihood.single.sampling.sample import log_volume

STRAY = 7.0  # squared distance over the variance; a rectangle's corners are at 6, a disc's rim at 4
TRIMS = 8
THINNEST = 0.05  # variance across an outline over the mean one: touched elements may be a line
LIGHT_EDGE = 0.25  # ln of a full element's load over the mean, whose edge is partly covered
ATTEMPTS = 3
NEAR = -1
SAME = 0.5  # log posterior within which another attempt has found the same
POOR, UNLIKELY = -1.5, -3.0
"""Surprise from which on there is no further attempt, and none once two have found the same."""
TRIES, MANY_TRIES = 8, 24
"""Outlines tried around the moments' own, in attempts after the first; of any but discs and
rectangles."""
PLACE_OFF, SIZE_OFF, TURN_OFF = 0.2, 0.08, 0.1
"""How far they are off: in pitches, in the logarithm of a size, in radians."""


@compiled_as_is
def moments(grid: Values, logs: Values, states: States) -> Values:
    """Return count, mean x and y, variances xx, xy and yy, and mean log load of what is touched.

    The variances count each element with its own extent; y runs down. Elements further from the
    mean than any of an outline's are left out, until none is: strays, far away on a large pad.
    """
    found = np.zeros(7)
    _moments_within(grid, logs, states, math.inf, found)
    for _ in range(TRIMS):
        count = found[0]
        if not _moments_within(grid, logs, states, STRAY, found) or found[0] == count:
            break
    return found


@compiled_as_is
def _moments_within(grid: Values, logs: Values, states: States, far: float, out: Values) -> bool:
    """Write the moments of what lies within a squared distance by moments; False if nothing."""
    pitch, half = grid[2], 0.5 * grid[3]
    left, top, area = grid[0] + half, grid[1] + half, pitch * pitch
    mean_x, mean_y = (out[1] - left) / pitch, (out[2] - top) / pitch
    det = max(out[3] * out[5] - out[4] * out[4], 1e-12 * area * area) / area
    a, b, c = out[5] / det, -2.0 * out[4] / det, out[3] / det
    count = x = y = xx = xy = yy = log = 0.0
    for i in range(states.shape[0]):
        v = i - mean_y
        for j in range(states.shape[1]):
            if states[i, j] != ON and states[i, j] != OVER:
                continue
            u = j - mean_x
            if far < math.inf and a * u * u + b * u * v + c * v * v > far:
                continue
            count += 1.0
            x += j
            y += i
            xx += j * j
            xy += i * j
            yy += i * i
            log += logs[i, j]
    if count == 0.0:
        return False
    x, y, own = x / count, y / count, 1.0 / 12.0
    out[0], out[6] = count, log / count
    out[1], out[2] = left + pitch * x, top + pitch * y
    out[3] = (xx / count - x * x + own) * area
    out[4] = (xy / count - x * y) * area
    out[5] = (yy / count - y * y + own) * area
    return True


@compiled_as_is
def outline_of_moments(
    kind: int, corners: int, found: Values, turn: float, thinnest: float, p: Values
) -> None:
    """Write an outline with given moments, and the load's logarithm, into ``p``.

    Parameters
    ----------
    kind, corners : int
        Of the outline, as in `outlines`.
    found : ndarray, shape (7,)
        As `moments` gives it.
    turn : float
        Angle in radians by which the outline is turned from where the moments have it.
    thinnest : float
        Least variance across, over the mean of the two.
    p : ndarray, shape (K,)
        Written, up to the load.
    """
    xx, xy, yy = found[3], found[4], found[5]
    p[0], p[1] = found[1], found[2]
    middle, off = 0.5 * (xx + yy), length(0.5 * (xx - yy), xy)
    major, minor = middle + off, max(middle - off, thinnest * middle)
    angle = 0.5 * math.atan2(-2.0 * xy, xx - yy) + turn
    last = 3
    if kind == DISC:
        p[2] = math.sqrt(4.0 * middle)
    elif kind in (ELLIPSE, OVAL, RECTANGLE):
        spread = 3.0 if kind == RECTANGLE else 4.0
        cos, sin = math.cos(turn), math.sin(turn)
        along, across = cos * cos, sin * sin
        p[2] = math.sqrt(spread * (major * along + minor * across))
        p[3] = math.sqrt(spread * (major * across + minor * along))
        p[4] = angle
        if kind == OVAL:
            to_oval(p)
        last = 5
    else:
        # the variance along any axis of a regular polygon, over that of its corners' circle
        step = 2.0 * math.pi / corners
        radius = math.sqrt(12.0 * middle / (2.0 + math.cos(step)))
        if kind == REGULAR:
            p[2], p[3] = radius, angle
            last = 4
        else:
            for k in range(corners):
                along = radius * math.sqrt(major / middle) * math.cos(turn + k * step)
                across = radius * math.sqrt(minor / middle) * math.sin(turn + k * step)
                cos, sin = math.cos(angle - turn), -math.sin(angle - turn)
                p[2 * k] = found[1] + along * cos - across * sin
                p[2 * k + 1] = found[2] + along * sin + across * cos
            last = 2 * corners
    p[last] = found[6] + LIGHT_EDGE


@compiled_as_is
def angles_to_try(kind: int, corners: int) -> int:
    """Return how many angles, over a period, are worth a try."""
    if kind == RECTANGLE:
        return 6
    return 4 if kind == REGULAR else 1


@compiled_as_is
def likeliest_start(problem: Problem, table: Values, tries: int, p: Values) -> None:
    """Write the likeliest of a few outlines around the touched elements' moments.

    Parameters
    ----------
    problem : Problem
    table : ndarray, shape (N, K)
        By how much they are off, as in `sample.Plan`.
    tries : int
        How many, beside the moments' own at a few angles.
    p : ndarray, shape (K,)
        Written.
    """
    kind, corners, guess = problem.kind, problem.corners, problem.guess
    found = moments(problem.grid, problem.logs, problem.states)
    first = unknowns(kind, corners)
    for k in range(guess.shape[0]):
        p[first + 1 + k] = guess[k, 0]
    best, trial = -math.inf, p.copy()
    ways = angles_to_try(kind, corners)
    for t in range(ways + tries):
        turn = (t % ways) * period(kind, corners) / ways
        outline_of_moments(kind, corners, found, turn, THINNEST, trial)
        if t >= ways:
            _vary(problem, table[t], trial)
        pulled_in(kind, corners, trial, problem.prior)
        here = log_rest(problem, trial)
        if here > -math.inf:
            here += log_likelihood(problem, trial)
        if here > best or t == 0:
            best = here
            p[:] = trial


@compiled_as_is
def _vary(problem: Problem, off: Values, p: Values) -> None:
    """Move an outline, in place, by a point of Student's t."""
    kind, corners, n = problem.kind, problem.corners, sizes(problem.kind)
    for k in range(unknowns(kind, corners)):
        if 2 <= k < 2 + n:
            p[k] *= math.exp(SIZE_OFF * (off[k] - 0.5))
        elif period(kind, corners) > 0.0 and k == 2 + n:
            p[k] += TURN_OFF * off[k]
        else:
            p[k] += PLACE_OFF * problem.grid[2] * off[k]


@compiled_as_is
def attempted(
    problem: Problem, table: Values, start: Values, attempt: int, least: float, p: Values,
    root: Values,
) -> tuple[float, float, GoodnessOfFit]:  # fmt: skip
    """Write the most likely outline as one attempt finds it.

    Parameters
    ----------
    problem : Problem
        Of at most 4096 touched elements.
    table : ndarray, shape (N, K)
        As in `sample.Plan`.
    start : ndarray, shape (0,) or (K,)
        Where to begin; empty for the touched elements' moments.
    attempt : int
        0 begins at the start if there is one, and so does `NEAR`, which takes it for near the top.
        So is a disc that has the moments of all that is touched: from there no search lets elements
        feel beyond their edge first. An outline with an angle would be caught beside the top.
    least : float
        Log posterior below which nobody asks how well it fits.
    p, root : ndarray, shape (K,) and (K, K)
        Written: the mode, and the lower root of the information there. Not as a `Mode`: handing
        over a second record costs 15 us.

    Returns
    -------
    (float, float, GoodnessOfFit)
        The mode's height, -inf where no outline is possible, the log evidence if the posterior were
        normal around it, and how well it fits.
    """
    if begins_softly(problem, table, start, attempt, p):
        maximise(softened(problem), p, root, ROUGH, math.inf)
    height = maximise(problem, p, root, ENOUGH, math.inf)
    return looked_at(problem, p, root, height, least)


@compiled_as_is
def begins_softly(problem: Problem, table: Values, start: Values, attempt: int, p: Values) -> bool:
    """Write where `attempted` begins; return whether elements feel beyond their edge at first."""
    if attempt <= 0 and start.shape[0] == p.shape[0]:
        p[:] = start
        return attempt >= 0
    tries = TRIES if problem.kind in (DISC, RECTANGLE) else MANY_TRIES
    likeliest_start(problem, table, max(attempt, 0) * tries, p)
    return attempt > 0 or (attempt == 0 and problem.kind != DISC)


@compiled_as_is
def looked_at(
    problem: Problem, p: Values, root: Values, height: float, least: float
) -> tuple[float, float, GoodnessOfFit]:
    """Return what `attempted` does of a mode."""
    if not height > least:
        return height, -math.inf, NO_FIT
    return height, height + log_volume(problem.kind, p, root), goodness_of_fit(problem, p)
