"""Touched elements in so many clusters at once: where sketches of a given number begin.

Parting one after another comes to six that touch by way of five that do not explain them. Here
elements go to the nearest middles, then to whose ellipse of the same moments they lie in most.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.several.beginnings.partings import OWN, SAME_CUT, count_in, sketch_of
from tactile_graph_likelihood.several.joint.joint_posterior import WIDTH, JointProblem
from tactile_graph_likelihood.several.joint.sketch import settle_sketches
from tactile_graph_likelihood.single.density.problem import Places

ROUNDS, OVAL_ROUNDS = 8, 5
"""Times that elements go to the nearest middles, and to ellipses."""

WIDER = 3.0
"""How much wider than an element's own extent ellipses are at least, as variances."""


@compiled_as_is
def clustered(
    problem: JointProblem, mask: NDArray[np.bool_], least: int, starts: int, found: Values,
    evidence: Values,
) -> None:  # fmt: skip
    """Write the best sketches of a number beside others for a mask, and the evidence of each.

    Clusters begin from some elements, one after another; those that are likeliest at first sight
    are climbed from.

    Parameters
    ----------
    problem : JointProblem
        Beside the others.
    mask : ndarray of bool, shape (rows, columns)
    least : int
        Elements of a cluster.
    starts : int
        Elements to begin from.
    found : ndarray, shape (M, K, 6)
    evidence : ndarray, shape (M,)
        Written; -inf where there are fewer.
    """
    most, count = found.shape[0], found.shape[1]
    at, log = elements_of(mask, problem.logs)
    n, own, sums = at.shape[0], np.empty(at.shape[0], np.int64), np.zeros((count, 7))
    begun, worth = np.zeros((starts, count, WIDTH)), np.full(starts, -math.inf)
    evidence[:] = -math.inf
    if n < least * count:
        return
    middles, number = np.zeros((starts, count, WIDTH)), 0
    for s in range(starts):
        first = s * (n - 1) // max(starts - 1, 1)
        if not gathered(at, log, first, least, own, sums):
            continue
        for k in range(count):
            sketch_of(sums[k], problem.grid, middles[number, k])
        known = False
        for other in range(number):
            known = known or same_places(
                middles[number], middles[other], SAME_CUT * problem.grid[2]
            )
        if known:
            continue
        begun[number] = middles[number]
        worth[number] = settle_sketches(problem, begun[number], 0, 1)
        number += 1
    for m in range(min(most, number)):
        best = int(np.argmax(worth))
        worth[best] = -math.inf
        found[m] = begun[best]
        evidence[m] = settle_sketches(problem, found[m], 1, 2)


@compiled_as_is
def elements_of(mask: NDArray[np.bool_], logs: Values) -> tuple[Values, Values]:
    """Return column and row of each element of a mask, shape (N, 2), and its log load."""
    n = 0
    for i in range(mask.shape[0]):
        for j in range(mask.shape[1]):
            n += mask[i, j]
    at, log = np.empty((n, 2)), np.empty(n)
    n = 0
    for i in range(mask.shape[0]):
        for j in range(mask.shape[1]):
            if mask[i, j]:
                at[n, 0], at[n, 1], log[n] = float(j), float(i), logs[i, j]
                n += 1
    return at, log


@compiled_as_is
def gathered(
    at: Values, log: Values, first: int, least: int, own: Places, sums: Values
) -> bool:  # fmt: skip
    """Gather elements in clusters; write whose each is, and the sums over each cluster's.

    Parameters
    ----------
    at, log : ndarray, shape (N, 2) and (N,)
    first : int
        Element that is a middle at first; the next are those farthest from all before.
    least : int
        Elements of a cluster.
    own : ndarray of int64, shape (N,)
    sums : ndarray, shape (K, 7)
        As `spread` has them.

    Returns
    -------
    bool
        False where a cluster has fewer elements.
    """
    count = sums.shape[0]
    middles, forms = farthest(at, first, count), np.zeros((count, 4))
    forms[:, 0] = forms[:, 2] = 1.0
    own[:] = -1
    for turn in range(ROUNDS + OVAL_ROUNDS):
        moved = False
        for i in range(at.shape[0]):
            best, near = 0, math.inf
            for k in range(count):
                dx, dy = at[i, 0] - middles[k, 0], at[i, 1] - middles[k, 1]
                far = forms[k, 0] * dx * dx + 2.0 * forms[k, 1] * dx * dy + forms[k, 2] * dy * dy
                far += forms[k, 3]
                if far < near:
                    best, near = k, far
            moved = moved or best != own[i]
            own[i] = best
        if not moved and turn > ROUNDS:
            break
        sum_up(at, log, own, sums)
        for k in range(count):
            a = sums[k]
            if a[0] < least:
                return False
            middles[k, 0], middles[k, 1] = a[1] / a[0], a[2] / a[0]
            if turn >= ROUNDS - 1:
                ellipse_of(a, forms[k])
    return True


@compiled_as_is
def farthest(at: Values, first: int, count: int) -> Values:
    """Return the places of an element and of those farthest from all before, shape (K, 2)."""
    n, found = at.shape[0], np.empty((count, 2))
    near, now = np.full(n, math.inf), first
    for k in range(count):
        found[k, 0], found[k, 1] = at[now, 0], at[now, 1]
        for i in range(n):
            far = (at[i, 0] - found[k, 0]) ** 2 + (at[i, 1] - found[k, 1]) ** 2
            near[i] = min(near[i], far)
        now = int(np.argmax(near))
    return found


@compiled_as_is
def sum_up(at: Values, log: Values, own: Places, sums: Values) -> None:
    """Write the sums over each cluster's elements, as `spread` has them."""
    sums[:, :] = 0.0
    for i in range(at.shape[0]):
        count_in(sums[own[i]], at[i, 0], at[i, 1], log[i])


@compiled_as_is
def ellipse_of(a: Values, form: Values) -> None:
    """Write xx, xy and yy of the inverse covariance of elements, and ln of its determinant."""
    n, own = a[0], WIDER * OWN
    xx, yy = a[3] / n - (a[1] / n) ** 2 + own, a[5] / n - (a[2] / n) ** 2 + own
    xy = a[4] / n - a[1] * a[2] / (n * n)
    whole = xx * yy - xy * xy
    form[0], form[1], form[2], form[3] = yy / whole, -xy / whole, xx / whole, math.log(whole)


@compiled_as_is
def same_places(one: Values, other: Values, far: float) -> bool:
    """Return whether each of some sketches lies where another does, but for a distance."""
    for k in range(one.shape[0]):
        near = math.inf
        for m in range(one.shape[0]):
            off = max(abs(one[k, 0] - other[m, 0]), abs(one[k, 1] - other[m, 1]))
            near = min(near, off)
        if near >= far:
            return False
    return True
