"""Outlines as each kind that they may be, beside others; and in the place of sketches."""

from __future__ import annotations

import math
from functools import cache
from typing import NamedTuple

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.outlines import (
    DISC,
    ELLIPSE,
    RECTANGLE,
    REGULAR,
    Values,
    sizes,
    unknowns,
)
from tactile_graph_likelihood.several.joint.joint_posterior import (
    WIDTH,
    JointProblem,
    Outlines,
    add_outline,
)
from tactile_graph_likelihood.several.joint.maximise_jointly import likeliest_of, settle
from tactile_graph_likelihood.several.joint.sketch import LIGHTER, REST, STAGES, settle_sketches
from tactile_graph_likelihood.single.density.problem import Places
from tactile_graph_likelihood.single.sampling.even_points import even_points

ROUNDS, FEW_ROUNDS, SOFT, ENOUGH = 8, 4, 4, 0.1
"""Rounds in which an outline of another kind is brought to its mode, of the same kind, and of the
soft search for the first kind that is drawn; the gain still promised below which they end."""

TRIES, HOPEFUL = 24, 4.0
"""Other starts of an outline that is drawn by itself, and how much less log evidence than the best
a kind may have for them."""

AROUND = np.array([0.19, 0.19, 0.15, 0.15, 0.15, 0.0])
"""How far other starts lie off: lengths in pitches, an angle in radians."""

TURNS = 4
"""Angles at which a regular polygon is begun with."""

ROUND = math.sqrt(4.0 / 3.0)
"""Half an ellipse's axis over the half side of the rectangle of the same moments."""

ROUND_FROM = 0.75
"""Ratio of a sketch's axes from which on it is taken to be a disc."""

SKETCH_OVAL = 1.086
"""Half axis of an ellipse over that of the sketch of the same area."""


class Allowed(NamedTuple):
    """What an outline may be.

    ``kinds`` and ``corners``, shape (K,), are as in `Outlines`; ``around``, shape (K, T, 6), is how
    far other starts of each kind lie off the first, lengths in pitches.
    """

    kinds: Places
    corners: Places
    around: Values


@cache
def allowed(kinds: tuple[tuple[int, int], ...]) -> Allowed:
    """Return what outlines may be, given kinds and their corners."""
    around = np.zeros((len(kinds), TRIES, WIDTH))
    for k, kind in enumerate(kinds):
        n = unknowns.call(*kind) + 1
        around[k, :, :n] = AROUND[:n] * even_points(TRIES, n, 0)
    return Allowed(np.array([kind for kind, _ in kinds]), np.array([n for _, n in kinds]), around)


@compiled_as_is
def filled(corners: int) -> float:
    """Return the area of a regular polygon whose corners are 1 from its centre."""
    return 0.5 * corners * math.sin(2.0 * math.pi / corners)


@compiled_as_is
def area(kind: int, corners: int, p: Values) -> float:
    """Return the area of an outline, in cm2; of no free polygon."""
    if kind == REGULAR:
        return p[2] * p[2] * filled(corners)  # type: ignore[no-any-return]
    if kind == RECTANGLE:
        return 4.0 * p[2] * p[3]  # type: ignore[no-any-return]
    return math.pi * p[2] * (p[2] if kind == DISC else p[3])  # type: ignore[no-any-return]


@compiled_as_is
def begun_like(kind: int, corners: int, was: int, edges: int, p: Values, starts: Values) -> int:
    """Write where an outline of about another's moments begins, and return at how many places.

    Parameters
    ----------
    kind, corners : int
        What it is to be.
    was, edges : int
        Kind and corners of the other one.
    p : ndarray, shape (6,)
        The other's numbers.
    starts : ndarray, shape (N, 6)
        Written. A regular polygon begins at `TURNS` angles.
    """
    n = unknowns(was, edges)
    if was == REGULAR:
        first = second = p[2] * math.sqrt(filled(edges) / math.pi)
    else:
        first, second = p[2], p[2] if was == DISC else p[3]
    angle = p[4] if was in (ELLIPSE, RECTANGLE) else 0.0
    scale = ROUND if was == RECTANGLE else 1.0
    first, second = scale * first, scale * second
    count = TURNS if kind == REGULAR else 1
    for k in range(count):
        row = starts[k]
        row[:] = 0.0
        row[0], row[1] = p[0], p[1]
        row[unknowns(kind, corners)] = p[n]
        if kind == DISC:
            row[2] = math.sqrt(0.5 * (first * first + second * second))
        elif kind == REGULAR:
            row[2] = math.sqrt(math.pi * first * second / filled(corners))
            row[3] = angle + k * 2.0 * math.pi / corners / TURNS
        else:
            scale = 1.0 / ROUND if kind == RECTANGLE else 1.0
            row[2], row[3], row[4] = scale * first, scale * second, angle
    return count


@compiled_as_is
def one_of(kind: int, corners: int, p: Values) -> Outlines:
    """Return one outline by itself, a copy."""
    point = np.empty((1, WIDTH))
    for m in range(WIDTH):
        point[0, m] = p[m]
    return Outlines(np.full(1, kind, np.int64), np.full(1, corners, np.int64), point)


@compiled_as_is
def settled_as(
    problem: JointProblem, may_be: Allowed, j: int, other: Outlines, tries: bool, found: Values
) -> float:
    """Bring the j-th of the kinds, near another outline, to its mode; return its log evidence.

    Parameters
    ----------
    problem : JointProblem
        Beside what else lies there.
    may_be : Allowed
    j : int
    other : Outlines
        One.
    tries : bool
        Whether it begins with the likeliest of some starts around it.
    found : ndarray, shape (6,)
        Written.
    """
    kind, corners = may_be.kinds[j], may_be.corners[j]
    n_tries = may_be.around.shape[1] if tries else 0
    starts, best = np.empty((TURNS + n_tries, WIDTH)), 0
    count = begun_like(kind, corners, other.kinds[0], other.corners[0], other.points[0], starts)
    pitch, lengths = problem.grid[2], 2 + sizes(kind)
    for t in range(n_tries):
        for m in range(WIDTH):
            off = may_be.around[j, t, m] * (pitch if m < lengths else 1.0)
            starts[count + t, m] = starts[0, m] + off
    count += n_tries
    if count > 1:
        best = likeliest_of(problem, kind, corners, starts[:count])
    one = one_of(kind, corners, starts[best])
    log: float = settle(problem, one, 0, ROUNDS, ENOUGH, np.empty((WIDTH, WIDTH)))
    for m in range(WIDTH):
        found[m] = one.points[0, m]
    return log


@compiled_as_is
def fits_of_kinds(
    problem: JointProblem, may_be: Allowed, own: Outlines, found: Values, logs: Values
) -> None:
    """Write one outline, near its mode, as each kind beside others, and the log evidence of each.

    Parameters
    ----------
    problem : JointProblem
    may_be : Allowed
    own : Outlines
        One.
    found, logs : ndarray, shape (K, 6) and (K,)
        Written.
    """
    for j in range(may_be.kinds.shape[0]):
        kind, corners = may_be.kinds[j], may_be.corners[j]
        if kind != own.kinds[0] or corners != own.corners[0]:
            logs[j] = settled_as(problem, may_be, j, own, False, found[j])
            continue
        one = one_of(kind, corners, own.points[0])
        logs[j] = settle(problem, one, 0, FEW_ROUNDS, ENOUGH, np.empty((WIDTH, WIDTH)))
        for m in range(WIDTH):
            found[j, m] = one.points[0, m]


@compiled_as_is
def guess(may_be: Allowed, sketch: Values, found: Values) -> int:
    """Write the outline of a likely kind that has a sketch's moments; return which kind."""
    oval, starts = sketch.copy(), np.empty((TURNS, WIDTH))
    oval[2] = SKETCH_OVAL * math.exp(sketch[2] + REST)
    oval[3] = SKETCH_OVAL * math.exp(sketch[3] + REST)
    oval[5] = sketch[5] - LIGHTER * REST
    is_round = min(oval[2], oval[3]) > ROUND_FROM * max(oval[2], oval[3])
    which = 0
    for j in range(may_be.kinds.shape[0]):
        if may_be.kinds[j] == (DISC if is_round else RECTANGLE):
            which = j
    begun_like(may_be.kinds[which], may_be.corners[which], ELLIPSE, 0, oval, starts)
    for m in range(WIDTH):
        found[m] = starts[0, m]
    return which


@compiled_as_is
def draw(
    problem: JointProblem, may_be: Allowed, points: Values, which: Places, least: float
) -> float:
    """Turn sketches into outlines beside others, each of the kind that explains most.

    Parameters
    ----------
    problem : JointProblem
    may_be : Allowed
    points : ndarray, shape (N, 6)
        Sketches; written: the outlines, at their joint mode.
    which : ndarray of int64, shape (N,)
        Written: which of the kinds each is.
    least : float
        Log evidence of the first kinds below which no others are tried.

    Returns
    -------
    float
        Log evidence.
    """
    n = points.shape[0]
    settle_sketches(problem, points, len(STAGES) - 1, len(STAGES))
    first, matrix = np.empty((n, WIDTH)), np.empty((n * WIDTH, n * WIDTH))
    outlines = Outlines(np.empty(n, np.int64), np.empty(n, np.int64), points)
    for k in range(n):
        which[k] = guess(may_be, points[k], first[k])
        outlines.kinds[k], outlines.corners[k] = may_be.kinds[which[k]], may_be.corners[which[k]]
        for m in range(WIDTH):
            points[k, m] = first[k, m]
    now = settle(problem, outlines, SOFT, ROUNDS, ENOUGH, matrix)
    if now < least:
        return now
    for k in range(n):
        rest = JointProblem(
            problem.grid, problem.logs, problem.states, problem.noise, problem.prior,
            problem.load.copy(), problem.share.copy(),
        )  # fmt: skip
        for m in range(n):
            if m != k:
                add_outline(rest, outlines, m)
        begun = one_of(outlines.kinds[k], outlines.corners[k], first[k])
        which[k] = _likeliest_kind(rest, may_be, outlines, k, which[k], begun, n == 1)
        outlines.kinds[k], outlines.corners[k] = may_be.kinds[which[k]], may_be.corners[which[k]]
    return settle(problem, outlines, 0, ROUNDS, ENOUGH, matrix)


@compiled_as_is
def _likeliest_kind(
    rest: JointProblem, may_be: Allowed, outlines: Outlines, k: int, its: int, begun: Outlines,
    tries: bool,
) -> int:  # fmt: skip
    """Write one of some outlines as the kind of the most evidence; return which that is.

    Each other kind begins near the outline; with ``tries`` each that may be the best begins around
    ``begun``, too.
    """
    own, point = one_of(outlines.kinds[k], outlines.corners[k], outlines.points[k]), np.empty(WIDTH)
    best, count = its, may_be.kinds.shape[0]
    most = settle(rest, own, 0, 0, ENOUGH, np.empty((WIDTH, WIDTH)))
    logs = np.full(count, most)
    for s in range(2 * count if tries else count):
        j, anew = s % count, s >= count
        if (logs[j] < most - HOPEFUL) if anew else (j == its):
            continue
        log = settled_as(rest, may_be, j, begun if anew else own, anew, point)
        if not anew:
            logs[j] = log
        if log > most:
            best, most = j, log
            for m in range(WIDTH):
                outlines.points[k, m] = point[m]
    return best
