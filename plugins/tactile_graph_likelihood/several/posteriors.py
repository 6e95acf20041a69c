"""The posteriors of outlines that were found together, and how well the frame fits them."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph.errors import Degenerate
from tactile_graph_likelihood.geometry.linear import cholesky, inverted
from tactile_graph_likelihood.geometry.outlines import Values, sizes
from tactile_graph_likelihood.several.joint.joint_posterior import WIDTH, JointProblem
from tactile_graph_likelihood.several.joint.kinds import fits_of_kinds
from tactile_graph_likelihood.several.joint.scene import Configuration, Sampled, area_of, laid
from tactile_graph_likelihood.several.pad import TEMPER, Found, OnPad
from tactile_graph_likelihood.several.search import Search
from tactile_graph_likelihood.single.density.goodness_of_fit import neighbours_of, unexplained
from tactile_graph_likelihood.single.posterior import Posterior

NEGLIGIBLE = 0.02
"""Probability over the likeliest outlines' below which others are left out."""

SAME = 0.115
"""Distance of centres that are the same, in pitches."""


class GoodnessOfLoad(NamedTuple):
    """How surprising an image is, and how much neighbours' gains are alike."""

    surprise: float
    neighbours: float


@compiled_as_is
def goodness_of_load(problem: JointProblem, fitted: int) -> GoodnessOfLoad:
    """Return how surprising an image is, and how much neighbours' gains are alike.

    Parameters
    ----------
    problem : JointProblem
        Its load is that of all outlines together.
    fitted : int
        How many numbers were fitted.

    Returns
    -------
    GoodnessOfLoad
        As of `goodness_of_fit`, but of the patterns only how alike neighbours are, not over the
        residuals' own variance.
    """
    left = unexplained(problem.load, 0.0, 0, 0, problem.logs, problem.states, problem.noise, fitted)
    its = neighbours_of(left.residuals)
    alike = its.product / math.sqrt(its.n_pairs) if its.n_pairs > 0.0 else 0.0
    return GoodnessOfLoad(left.surprise, alike)


def posteriors(problem: JointProblem, found: OnPad) -> tuple[list[Posterior], GoodnessOfLoad]:
    """Return each outline's posterior, and how well all together explain a pad."""
    every = [one for part in found.parts for one in posteriors_of(part)]
    counts, points = [len(one.mean) for one in every], np.zeros((len(every), WIDTH))
    for row, one, n in zip(points, every, counts, strict=True):
        row[:n] = one.most_likely
    kinds, corners = [one.kind for one in every], [one.corners for one in every]
    together = Configuration(np.array(kinds), np.array(corners), points, 0.0)
    fit = goodness_of_load.call(laid(problem, together), sum(counts))
    return [replace(one, surprise=fit.surprise, neighbours=fit.neighbours) for one in every], fit


def posteriors_of(part: Found) -> list[Posterior]:
    """Return the posteriors of the outlines of a part of a pad.

    Notes
    -----
    Each outline is fitted as each kind beside the others, and the likeliest kind's points are
    sampled there; they are then spread by what the others' own uncertainty adds to their
    covariance, from the information of all together, and by how far the other kinds, and other
    outlines that the search came upon, lie off.
    """
    scene = part.scene
    found, matrix, every, sampled = _sampled(scene, part.outlines)
    if any(
        some.log_evidence == -math.inf for some in sampled
    ):  # of kinds that others leave no room
        found, matrix, every, sampled = _sampled(scene, part.outlines, as_found=True)
    together = np.asarray(np.linalg.inv(matrix), dtype=np.float64)
    others, out = others_of(part), []
    for k, (kinds, some) in enumerate(zip(every, sampled, strict=True)):
        if some.log_evidence == -math.inf:
            raise Degenerate("no outline near the likeliest one is possible: none can be told")
        n = some.points.shape[1]
        here = slice(k * WIDTH, k * WIDTH + n)
        shift, spread = kinds.apart(n)
        spread = spread + spread_of_others(others, found.only(k), n)
        points, mean, wider = widened.call(
            some.points, some.weights, matrix[here, here], together[here, here], spread, shift
        )
        out.append(
            Posterior(
                int(found.kinds[k]), int(found.corners[k]), mean, wider, points, some.weights,
                found.points[k, :n].copy(), some.log_evidence, some.equal_points, 0.0, 0.0,
            )
        )  # fmt: skip
    return out


class Widened(NamedTuple):
    """Points, their mean and their covariance: shapes (N, K), (K,) and (K, K)."""

    points: Values
    mean: Values
    covariance: Values


@compiled_as_is
def widened(
    points: Values, weights: Values, alone: Values, together: Values, spread: Values, shift: Values
) -> Widened:
    """Return points spread by what is not known of the others, and by how far other answers lie.

    Parameters
    ----------
    points, weights : ndarray, shape (N, K) and (N,)
        Of the outline beside the others as they are.
    alone : ndarray, shape (K, K)
        The information there.
    together : ndarray, shape (K, K)
        Its covariance from the information of all together.
    spread, shift : ndarray, shape (K, K) and (K,)
        What other answers add to the covariance, and to the mean.

    Returns
    -------
    Widened
    """
    count, n = points.shape
    mean, off, total = np.zeros(n), np.empty((count, n)), 0.0
    for i in range(count):
        total += weights[i] * weights[i]
        for m in range(n):
            mean[m] += weights[i] * points[i, m]
    for i in range(count):
        for m in range(n):
            off[i, m] = points[i, m] - mean[m]
    root, made = np.empty((n, n)), np.zeros((n, n))
    cholesky(alone, root)
    spread_by(off, inverted(root), together)
    for i in range(count):
        for a in range(n):
            for b in range(n):
                made[a, b] += off[i, a] * weights[i] * off[i, b]
    made /= max(1.0 - total, 0.05)
    wider = made + spread
    spread_by(off, made, wider)
    for m in range(n):
        mean[m] += shift[m]
        for i in range(count):
            off[i, m] += mean[m]
    return Widened(off, mean, wider)


@compiled_as_is
def spread_by(off: Values, before: Values, after: Values) -> None:
    """Turn points around 0 of one covariance, in place, into those of another.

    They stay as they are where a covariance is none: of points on one line.
    """
    (count, n), root, wide = off.shape, np.empty(before.shape), np.empty(before.shape)
    if not (cholesky(before, root) and cholesky(after, wide)):
        return
    plain = np.empty(n)
    for i in range(count):
        for a in range(n):
            total = off[i, a]
            for b in range(a):
                total -= root[a, b] * plain[b]
            plain[a] = total / root[a, a]
        for a in range(n):
            total = 0.0
            for b in range(a + 1):
                total += wide[a, b] * plain[b]
            off[i, a] = total


def _sampled(
    scene: Search, outlines: Configuration, as_found: bool = False
) -> tuple[Configuration, Values, list[Kinds], list[Sampled]]:
    """Return outlines, each of its likeliest kind or as found, and what is known of each.

    That is: the information of all together, each as every kind, and its points.
    """
    found, matrix = scene.settled(outlines)
    every = list[Kinds]()
    for k in range(found.count):
        kinds = kinds_of(scene, found, k)
        every.append(replace(kinds, best=found.only(k)) if as_found else kinds)
        found = found.with_one(k, every[-1].best)
    if not as_found:
        found, matrix = scene.settled(found, None, 4)
    return found, matrix, every, [scene.sampled(found, k) for k in range(found.count)]


@dataclass(frozen=True, eq=False)
class Kinds:
    """One outline as each kind, beside others: fits, the likeliest one, and their probabilities."""

    fits: list[Configuration]
    best: Configuration
    chances: Values

    def apart(self, n: int) -> tuple[Values, Values]:
        """Return how far the mean over all kinds lies off the likeliest one's, and their spread.

        Shapes (n,) and (n, n): of the centre and, all sizes alike, of the root of the area.
        """
        offs = np.array([_off(fit, self.best, n) for fit in self.fits])
        shift = self.chances @ offs
        spread = (offs * self.chances[:, None]).T @ offs - np.outer(shift, shift)
        return shift, spread


def kinds_of(scene: Search, found: Configuration, k: int) -> Kinds:
    """Return one outline as each kind beside the others."""
    may_be, n = scene.may_be, len(scene.kinds)
    points, evidence = np.empty((n, WIDTH)), np.empty(n)
    fits_of_kinds.call(scene.beside(found, k), may_be, found.only(k).outlines, points, evidence)
    fits = [
        Configuration(may_be.kinds[j : j + 1], may_be.corners[j : j + 1], points[j : j + 1], log)
        for j, log in enumerate(evidence.tolist())
    ]
    fits = [fit for fit in fits if fit.log_evidence > -math.inf]
    if not fits:
        raise Degenerate("an outline is possible as none of the kinds: none can be told")
    logs = np.array([fit.log_evidence for fit in fits]) / (TEMPER * scene.shared)
    chances = np.exp(logs - logs.max())
    return Kinds(fits, fits[int(logs.argmax())], chances / chances.sum())


def others_of(part: Found) -> list[tuple[float, Configuration]]:
    """Return other outlines of a part that lie elsewhere, each with its chance over the likeliest.

    Of those at the same places the first.
    """
    others, far_cm = list[tuple[float, Configuration]](), SAME * float(part.scene.problem.grid[2])
    for log, other in part.others:
        chance = math.exp(min(log / TEMPER, 0.0))
        if chance < NEGLIGIBLE or _are_same(other, part.outlines, far_cm):
            continue
        if not any(_are_same(other, it, far_cm) for _, it in others):
            others.append((chance, other))
    return others


def spread_of_others(
    others: list[tuple[float, Configuration]], one: Configuration, n: int
) -> Values:
    """Return the covariance that other outlines add to one of the likeliest."""
    spread, total = np.zeros((n, n)), 1.0
    for chance, other in others:
        far = np.hypot(*(other.points[:, :2] - one.points[0, :2]).T)
        off = _off(other.only(int(far.argmin())), one, n)
        spread += chance * np.outer(off, off)
        total += chance
    return spread / total


def _are_same(one: Configuration, other: Configuration, far_cm: float) -> bool:
    """Return whether outlines lie at the same places, but for a distance."""
    if one.count != other.count:
        return False
    off = one.points[:, None, :2] - other.points[None, :, :2]
    return bool((np.abs(off).max(axis=2).min(axis=1) < far_cm).all())


def _off(found: Configuration, one: Configuration, n: int) -> Values:
    """Return how far an outline lies off another, in the other's numbers, all sizes alike."""
    off, own = np.zeros(n), sizes.call(int(one.kinds[0]))
    off[:2] = found.points[0, :2] - one.points[0, :2]
    ratio = math.sqrt(area_of(found) / area_of(one))
    off[2 : 2 + own] = (ratio - 1.0) * one.points[0, 2 : 2 + own]
    return off
