"""An outline as every kind that is looked for, beside others."""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.outlines import (
    DISC,
    ELLIPSE,
    RECTANGLE,
    REGULAR,
    Values,
    unknowns,
)
from tactile_graph_likelihood.several.alike import filled
from tactile_graph_likelihood.several.joint_posterior import (
    WIDTH,
    JointProblem,
    Outlines,
    log_posterior_of,
)
from tactile_graph_likelihood.several.maximise_jointly import settle
from tactile_graph_likelihood.single.problem import Places

ROUNDS = 8
"""Rounds in which an outline of another kind is brought to its mode."""

TURNS = 4
"""Angles at which a regular polygon is begun with."""

ROUND = math.sqrt(4.0 / 3.0)
"""Half an ellipse's axis over the half side of the rectangle of the same moments."""


@compiled_as_is
def as_kinds(
    problem: JointProblem, own: Outlines, kinds: Places, rounds: int, around: Values,
    logs: Values, points: Values,
) -> None:  # fmt: skip
    """Bring an outline to its mode as each kind; write the log evidence there, and the points.

    Parameters
    ----------
    problem : JointProblem
        Beside others.
    own : Outlines
        One outline; it stays of its own kind for ``rounds`` rounds.
    kinds : ndarray of int64, shape (K, 2)
        Kinds and corners.
    around : ndarray, shape (K, N, 6)
        How far other starts lie off that are looked at; with any, the own kind is as any other.
    logs, points : ndarray, shape (K,) and (K, 6)
        Written.
    """
    matrix, tries = np.empty((WIDTH, WIDTH)), around.shape[1]
    for m in range(kinds.shape[0]):
        its = Outlines(kinds[m, :1], kinds[m, 1:], points[m : m + 1])
        same = tries == 0 and its.kinds[0] == own.kinds[0] and its.corners[0] == own.corners[0]
        starts = own.points if same else starts_of(its.kinds[0], its.corners[0], own, around[m])
        at = likeliest_start(problem, its, starts) if starts.shape[0] > 1 else 0
        points[m, :] = starts[at]
        logs[m] = settle(problem, its, 0, rounds if same else ROUNDS, 0.1, matrix)


@compiled_as_is
def likeliest_start(problem: JointProblem, kind: Outlines, starts: Values) -> int:
    """Return which of some points, shape (N, 6), of an outline's kind is likeliest."""
    best, at = -math.inf, 0
    for k in range(starts.shape[0]):
        log = log_posterior_of(problem, Outlines(kind.kinds, kind.corners, starts[k : k + 1]))
        if log > best:
            best, at = log, k
    return at


@compiled_as_is
def starts_of(kind: int, corners: int, own: Outlines, around: Values) -> Values:
    """Return points of a kind of about an outline's moments, shape (N, 6), and some around it.

    A regular polygon is turned, too.
    """
    turns = TURNS if kind == REGULAR else 1
    found = np.zeros((turns + around.shape[0], WIDTH))
    for k in range(turns):
        like(kind, corners, own, k, found[k])
    for k in range(around.shape[0]):
        for x in range(WIDTH):
            found[turns + k, x] = found[0, x] + around[k, x]
    return found


@compiled_as_is
def like(kind: int, corners: int, own: Outlines, turn: int, out: Values) -> None:
    """Write the point of a kind of outline that has about another's moments."""
    p, was = own.points[0], own.kinds[0]
    if was == REGULAR:
        first = second = p[2] * math.sqrt(filled(own.corners[0]) / math.pi)
    else:
        first, second = p[2], p[2] if was == DISC else p[3]
    angle = p[4] if was in (ELLIPSE, RECTANGLE) else 0.0
    scale = ROUND if was == RECTANGLE else 1.0
    first, second = scale * first, scale * second
    out[0], out[1] = p[0], p[1]
    if kind == DISC:
        out[2] = math.sqrt(0.5 * (first * first + second * second))
    elif kind == REGULAR:
        out[2] = math.sqrt(math.pi * first * second / filled(corners))
        out[3] = angle + turn * 2.0 * math.pi / corners / TURNS
    else:
        scale = 1.0 / ROUND if kind == RECTANGLE else 1.0
        out[2], out[3], out[4] = scale * first, scale * second, angle
    out[unknowns(kind, corners)] = p[unknowns(was, own.corners[0])]
