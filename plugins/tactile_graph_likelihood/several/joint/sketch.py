"""Outlines as sketches: one kind that is neither round nor angular, with a soft edge.

A search has to look at many partings of what is touched, most of them far off. A sketch's coverage
is a smooth function of the distance from its edge, so that its slopes cost next to nothing and a
touched element pulls from outside, too; its likelihood and evidence are otherwise those of
`joint_posterior`. It is the outline ``(u / a)**4 + (v / b)**4 = 1``; a row holds its centre in cm,
ln a, ln b, the angle of the first axis and the logarithm of its load.
"""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.linear import cholesky, solved
from tactile_graph_likelihood.geometry.outline_prior import HEIGHT, LARGEST, LEFT, SMALLEST, TOP
from tactile_graph_likelihood.geometry.outline_prior import WIDTH as ACROSS
from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.several.joint.joint_posterior import (
    MIDDLE,
    SPREAD,
    WIDTH,
    JointProblem,
    lightest,
)
from tactile_graph_likelihood.single.density.element_terms import LEAST, OFF, SIGMA, UNKNOWN
from tactile_graph_likelihood.single.density.information import (
    MOST_ODDS,
    SLIVER,
    Information,
    mirror,
    scatter_of,
    score_of,
)

STAGES = (
    (4.0, 1.5, 2.0, 0.0),
    (4.0, 1.2, 1.0, 0.1),
    (4.0, 0.9, 1.0, 0.085),
)
"""Rounds of each stage of a climb, half its edge's width in sides of an element, its sigma over the
noise's, and what it adds to ln of a size: the wider the edge, the smaller an outline seems."""

LIGHTER = 1.5
"""What is taken off ln of a load, over what is added to ln of a size."""

REST = 0.06
"""What is added to ln of a size at last."""

ENOUGH = 0.1
"""Gain in log posterior below which a stage ends."""

OVERLAP = 0.2
"""Standard deviation of the coverage by which sketches, together, may exceed an element."""

LOOSE, GAP = 0.05, 6.0
"""Information, per squared pitch, that is added to each number's own: in steps, and for the
evidence."""

LONGEST = 1.0, 1.0, 0.4, 0.4, 0.5, 0.7
"""Longest step of each number; of the centre in pitches."""

HALF_LN_TWO_PI = 0.5 * math.log(2.0 * math.pi)


@compiled_as_is
def frame_of(p: Values, out: Values) -> None:
    """Write what `cover` takes of a sketch: centre, axes over their lengths, both lengths.

    Last comes what no slope of the distance from the centre exceeds.
    """
    cos, sin = math.cos(p[4]), math.sin(p[4])
    a, b = math.exp(p[2]), math.exp(p[3])
    out[0], out[1], out[2], out[3] = p[0], p[1], cos / a, sin / a
    out[4], out[5], out[6] = cos / b, sin / b, b / a
    out[7] = math.sqrt(1.0 / (a * a) + 1.0 / (b * b))


@compiled_as_is
def cover(frame: Values, x_cm: float, y_cm: float, half: float, rise: Values) -> float:
    """Return a sketch's coverage of a place; write its slope along centre, sizes and angle.

    ``half`` is half the edge's width, in cm. Slopes are written only within the edge, as if its
    width over the sketch's own stayed what it is there.
    """
    dx, dy = x_cm - frame[0], y_cm - frame[1]
    s, t = dx * frame[2] - dy * frame[3], -dx * frame[5] - dy * frame[4]
    s3, t3 = s * s * s, t * t * t
    r4 = s3 * s + t3 * t
    if r4 < 0.02:
        return 1.0
    far = 1.0 + half * frame[7]
    if r4 > far * far * far * far:
        return 0.0
    r = math.sqrt(math.sqrt(r4))
    cube = r4 / r
    s3, t3 = s3 / cube, t3 / cube
    right, up = s3 * frame[2] - t3 * frame[5], s3 * frame[3] + t3 * frame[4]
    steep = math.sqrt(right * right + up * up) * half
    at = 0.5 - 0.5 * (r - 1.0) / steep
    if at <= 0.0:
        return 0.0
    if at >= 1.0:
        return 1.0
    fall = -3.0 * at * (1.0 - at) / steep
    rise[0] = -fall * right
    rise[1] = fall * up
    rise[2] = -fall * s * s3
    rise[3] = -fall * t * t3
    rise[4] = fall * (s3 * t * frame[6] - t3 * s / frame[6])
    return at * at * (3.0 - 2.0 * at)


@compiled_as_is
def log_prior(problem: JointProblem, points: Values, out: Information) -> float:
    """Return the log prior density of sketches; write its slope and information, alone so far."""
    prior, (slope, matrix) = problem.prior, out
    flat = math.log(prior[ACROSS] * prior[HEIGHT]) + math.log(0.5 * math.pi) + HALF_LN_TWO_PI
    flat += 2.0 * math.log(math.log(prior[LARGEST] / prior[SMALLEST])) + math.log(prior[SPREAD])
    for x in range(slope.shape[0]):
        slope[x] = 0.0
        for y in range(slope.shape[0]):
            matrix[x, y] = 0.0
    total = 0.0
    for k in range(points.shape[0]):
        off, at = (points[k, 5] - prior[MIDDLE]) / prior[SPREAD], k * WIDTH + 5
        total -= 0.5 * off * off + flat
        slope[at] = -off / prior[SPREAD]
        matrix[at, at] = 1.0 / (prior[SPREAD] * prior[SPREAD])
    return total


@compiled_as_is
def windows(grid: Values, points: Values, half: float, shape: tuple[int, int]) -> Values:
    """Return first and last row and column, and one more, of each sketch's elements, (K, 4)."""
    found = np.empty((points.shape[0], 4))
    for k in range(points.shape[0]):
        reach = 1.2 * math.exp(max(points[k, 2], points[k, 3])) + half
        for m in range(2):
            middle = (points[k, 1 - m] - grid[1 - m] - 0.5 * grid[3]) / grid[2]
            found[k, 2 * m] = max(math.ceil(middle - reach / grid[2]), 0.0)
            found[k, 2 * m + 1] = min(math.floor(middle + reach / grid[2]) + 1.0, shape[m])
    return found


@compiled_as_is
def log_posterior(problem: JointProblem, points: Values, half: float, out: Information) -> float:
    """Return what sketches add to the log posterior of a problem; write slope and information."""
    grid, noise, states, count = problem.grid, problem.noise, problem.states, points.shape[0]
    total, scatter = log_prior(problem, points, out), scatter_of(noise)
    box = windows(grid, points, half, states.shape)
    frame, scale = np.empty((count, 8)), np.empty(count)
    own, rise, size = np.empty(count), np.empty((count, WIDTH)), count * WIDTH
    along, tight, used = np.empty(size), np.empty(size), np.empty(size, np.int64)
    rows, cols = states.shape
    first, last, left, right = rows, 0, cols, 0
    for k in range(count):
        frame_of(points[k], frame[k])
        scale[k] = math.exp(points[k, 5])
        first, last = min(first, int(box[k, 0])), max(last, int(box[k, 1]))
        left, right = min(left, int(box[k, 2])), max(right, int(box[k, 3]))
    odds, latest, log_load = 1.0, 1.0, 0.0
    for i in range(first, last):
        y_cm = grid[1] + 0.5 * grid[3] + grid[2] * i
        for j in range(left, right):
            x_cm = grid[0] + 0.5 * grid[3] + grid[2] * j
            more, bare = 0.0, problem.load[i, j]
            load = bare
            for k in range(count):
                own[k] = 0.0
                if box[k, 0] <= i < box[k, 1] and box[k, 2] <= j < box[k, 3]:
                    own[k] = cover(frame[k], x_cm, y_cm, half, rise[k])
                    more += own[k]
                    load += scale[k] * own[k]
            if more <= 0.0:
                continue
            state, score, weight = states[i, j], 0.0, 0.0
            if state != UNKNOWN:
                log = noise[LEAST] if state == OFF else problem.logs[i, j]
                if load != latest:
                    latest, log_load = load, math.log(load)
                likelier, its = score_of(state, log, log_load, scatter)
                score, weight = its[0], its[1]
                odds *= likelier
                if bare > 0.0:
                    likelier, _ = score_of(state, log, math.log(bare), scatter)
                    odds /= likelier
                if not 1.0 / MOST_ODDS < odds < MOST_ODDS:
                    total += math.log(odds)
                    odds = 1.0
            before, push = problem.share[i, j] - 1.0, 0.0
            over = before + more
            if over > 0.0:
                push = 1.0 / (OVERLAP * OVERLAP)
                total -= 0.5 * push * (over * over - max(before, 0.0) ** 2)
            n = 0
            for k in range(count):
                if own[k] <= 0.0:
                    continue
                if own[k] < 1.0:
                    per_load = scale[k] / max(load, SLIVER * scale[k])
                    for m in range(5):
                        along[n], tight[n] = per_load * rise[k, m], rise[k, m]
                        used[n] = k * WIDTH + m
                        n += 1
                along[n], tight[n] = scale[k] * own[k] / load, 0.0
                used[n] = k * WIDTH + 5
                n += 1
            for a in range(
                n
            ):  # written out, as in `slopes`: arrays handed over are counted each time
                x, by_load, by_share = used[a], weight * along[a], push * tight[a]
                out.slope[x] += score * along[a] - over * by_share
                for b in range(a + 1):
                    out.matrix[x, used[b]] += by_load * along[b] + by_share * tight[b]
    mirror(out.matrix)
    return total + math.log(odds)


@compiled_as_is
def add_loose(points: Values, pitch: float, loose: float, matrix: Values) -> None:
    """Add information on each length, of so much per squared pitch."""
    for k in range(points.shape[0]):
        a, b, at = math.exp(points[k, 2]), math.exp(points[k, 3]), k * WIDTH
        one = loose / (pitch * pitch)
        matrix[at, at] += one
        matrix[at + 1, at + 1] += one
        matrix[at + 2, at + 2] += one * a * a
        matrix[at + 3, at + 3] += one * b * b
        matrix[at + 4, at + 4] += one * max(a, b) ** 2


@compiled_as_is
def step_from(problem: JointProblem, points: Values, step: Values, trial: Values) -> None:
    """Write sketches a step further, no longer than sensible, to where the prior is not zero."""
    prior, pitch = problem.prior, problem.grid[2]
    low, high = math.log(prior[SMALLEST]), math.log(prior[LARGEST])
    for k in range(points.shape[0]):
        for m in range(WIDTH):
            most = LONGEST[m] * (pitch if m < 2 else 1.0)
            trial[k, m] = points[k, m] + min(max(step[k * WIDTH + m], -most), most)
        trial[k, 0] = min(max(trial[k, 0], prior[LEFT]), prior[LEFT] + prior[ACROSS])
        trial[k, 1] = min(max(trial[k, 1], prior[TOP]), prior[TOP] + prior[HEIGHT])
        for m in range(2, 4):
            trial[k, m] = min(max(trial[k, m], low), high)
        trial[k, 5] = max(trial[k, 5], lightest(problem.noise))


@compiled_as_is
def maximise_sketches(
    problem: JointProblem, points: Values, rounds: int, half: float, out: Information,
    new: Information,
) -> float:  # fmt: skip
    """Bring sketches, in place, near their joint mode; return the log evidence around it."""
    pitch, size = problem.grid[2], points.shape[0] * WIDTH
    tight, root, step = np.empty((size, size)), np.empty((size, size)), np.empty(size)
    trial = points.copy()
    now, damping = log_posterior(problem, points, half, out), 0.0
    for _ in range(rounds):
        for x in range(size):
            for y in range(size):
                tight[x, y] = out.matrix[x, y]
        add_loose(points, pitch, LOOSE, tight)
        for x in range(size):
            tight[x, x] *= 1.0 + damping
        if not cholesky(tight, root):
            break
        solved(root, out.slope, step)
        step_from(problem, points, step, trial)
        then = log_posterior(problem, trial, half, new)
        if not then > now:
            if damping > 50.0:
                break
            damping = max(1.0, 10.0 * damping)
            continue
        gained, now = then - now, then
        for x in range(size):
            points[x // WIDTH, x % WIDTH] = trial[x // WIDTH, x % WIDTH]
        out, new = new, out
        damping *= 0.1
        if gained < ENOUGH:
            break
    add_loose(points, pitch, GAP, out.matrix)
    if not cholesky(out.matrix, root):
        return -math.inf
    for x in range(size):
        now += HALF_LN_TWO_PI - math.log(root[x, x])
    return now


@compiled_as_is
def settle_sketches(problem: JointProblem, points: Values, first: int, last: int) -> float:
    """Bring sketches, in place, near their joint mode in some of `STAGES`.

    Returns
    -------
    float
        Log evidence around where they end, with the last stage's edge.
    """
    size = points.shape[0] * WIDTH
    out = Information(np.empty(size), np.empty((size, size)))
    new = Information(np.empty(size), np.empty((size, size)))
    noise, now = problem.noise.copy(), -math.inf
    for stage in range(first, last):
        rounds, edge, uneven, grow = STAGES[stage]
        noise[SIGMA] = uneven * problem.noise[SIGMA]
        here = JointProblem(
            problem.grid, problem.logs, problem.states, noise, problem.prior, problem.load,
            problem.share,
        )  # fmt: skip
        for k in range(points.shape[0] if stage > first else 0):
            points[k, 2] += grow
            points[k, 3] += grow
            points[k, 5] -= LIGHTER * grow
        now = maximise_sketches(here, points, int(rounds), edge * problem.grid[3], out, new)
    return now
