"""Which manner of discriminant tells learned objects apart best, by leaving readings out."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import lru_cache
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar
from scipy.special import logsumexp

from tactile_graph_classifiers.database.choice import CONFIDENCE, Choice, Manner
from tactile_graph_classifiers.distances.discriminant_model import Labels, Learned, Scores
from tactile_graph_classifiers.distances.examples import Examples, Packed, runs_of
from tactile_graph_classifiers.distances.left_out import largest_accepted

Array = NDArray[np.float64]
SHRINKAGES = (0.3, 0.1, 0.03, 0.01)
VARIATES = (8, 15, 25)
PRIORS = (60.0, 16.0, 5.0)
BEYOND = (1.0, 0.3, 0.1, 0.03, 0.0)
PIECES = 20
"""Of so many pieces one is left out at a time to learn what is accepted: of a smaller part of the
readings less is learned, and it would seem that known objects vary more than they do."""
PARTS = 5
"""In so many parts readings and objects are left out while choosing."""
HOTTEST = 1e4
BY_CHANCE = 2.0
"""Logarithms of likelihood that a temperature gains in one of twenty times where none is needed:
half the 95 % quantile of chi squared."""


class Tried(NamedTuple):
    """What one manner did with what was left out.

    Parameters
    ----------
    manner : Manner
    n_right : int
        Readings named right that were left out.
    log_likelihood : float
        Of their true objects.
    own, strangers : list of ndarray
        Squared distances to what they were named, for each of `BEYOND`: of the same readings, and
        of those of objects left out whole.
    """

    manner: Manner
    n_right: int
    log_likelihood: float
    own: list[Array]
    strangers: list[Array]

    def found(self) -> tuple[int, float]:
        """Return how many strangers are unknown, and by which ``beyond``."""
        if not self.strangers[0].size:
            return 0, BEYOND[0]
        counts = [
            int(np.count_nonzero(theirs > largest_accepted(its, CONFIDENCE)))
            for its, theirs in zip(self.own, self.strangers, strict=True)
        ]
        at = int(np.argmax(counts))
        return counts[at], BEYOND[at]


def choose_once(examples: Examples) -> Choice:
    """Return what `choose` does; of the same examples at once, as far as this process remembers.

    A pipeline is loaded again whenever it is saved, and by each of many variants.

    Parameters
    ----------
    examples : Examples
    """
    return _chosen(*examples.packed())


@lru_cache(maxsize=8)
def _chosen(*parts: Packed) -> Choice:
    return choose(Examples.unpacked(parts))


def choose(examples: Examples) -> Choice:
    """Return the manner that does best with what is left out.

    Parameters
    ----------
    examples : Examples

    Notes
    -----
    Of the manners that name as many readings right as the best one, but for a standard error,
    the one is taken that finds most strangers; of equal ones that of the highest likelihood, and
    then the most cautious. Whole runs of successive readings are left out: neighbours may be
    alike for reasons that will not come again. Strangers are a fifth of the objects at a time.
    """
    tried = [one for shrinkage in SHRINKAGES for one in _tried(examples, shrinkage)]
    n = len(tried[0].own[0])
    most = max(one.n_right for one in tried)
    error = math.sqrt(most * (n - most) / n) if n else 0.0
    good = [one for one in tried if one.n_right >= most - error]
    best = max(good, key=lambda one: (one.found()[0], one.n_right, one.log_likelihood))
    found, beyond = best.found()
    return Choice(best.manner._replace(beyond=beyond), n, best.n_right, len(best.strangers[0]),
                  found)  # fmt: skip


def left_out_names(examples: Examples, manner: Manner) -> tuple[Labels, Labels]:
    """Return which objects readings that were left out are of, and which they were named, (N,).

    Parameters
    ----------
    examples : Examples
    manner : Manner
    """
    true, named = [np.zeros(0, np.intp)], [np.zeros(0, np.intp)]
    for learned, coordinates, labels in _without_readings(examples, manner.shrinkage, PARTS):
        true.append(labels)
        scores = learned.discriminant(manner)(coordinates)
        named.append(scores.unlikeliness.argmin(axis=1))
    return np.concatenate(true), np.concatenate(named)


class NamedLeftOut(NamedTuple):
    """Readings, or means of several, that were named by what was learned without them.

    Parameters
    ----------
    squares : ndarray, shape (N,)
        Squared distance of each to what it was named.
    unlikeliness : ndarray, shape (N, K)
        Minus twice the log likelihood of each object, up to a constant.
    labels : ndarray of int, shape (N,)
        Which object each truly is of.
    """

    squares: Array
    unlikeliness: Array
    labels: Labels

    def temperature(self) -> float:
        """Return by what logarithms of likelihoods are to be divided to be as sure as is right.

        Returns
        -------
        float
            That of highest likelihood of the true objects, at least 1; 1 where no other is better
            by more than chance.

        Notes
        -----
        C. Guo et al., On calibration of modern neural networks, 2017, arXiv:1706.04599.
        """

        def surprise(log_temperature: float) -> float:
            logs = -0.5 * math.exp(-log_temperature) * self.unlikeliness
            true = logs[np.arange(len(self.labels)), self.labels]
            return float((logsumexp(logs, axis=1) - true).sum())

        if len(self.labels) == 0:
            return 1.0
        best = minimize_scalar(surprise, bounds=(0.0, math.log(HOTTEST)), method="bounded")
        return math.exp(best.x) if surprise(0.0) - best.fun > BY_CHANCE else 1.0


def name_once(examples: Examples, manner: Manner, n_presses: int) -> NamedLeftOut:
    """Return what `name_left_out` does; of the same at once, as `choose_once` does.

    Parameters
    ----------
    examples : Examples
    manner : Manner
    n_presses : int
    """
    return _named(manner, n_presses, *examples.packed())


@lru_cache(maxsize=8)
def _named(manner: Manner, n_presses: int, *parts: Packed) -> NamedLeftOut:
    return name_left_out(Examples.unpacked(parts), manner, n_presses)


def name_left_out(examples: Examples, manner: Manner, n_presses: int = 1) -> NamedLeftOut:
    """Return what was left out, named by the rest of the readings.

    Parameters
    ----------
    examples : Examples
    manner : Manner
    n_presses : int
        So many successive readings of an object are named together by their mean.
    """
    runs = runs_of(np.bincount(examples.labels).tolist(), n_presses)
    n_runs = int(runs.max()) + 1
    n_groups = math.ceil(PIECES / max(n_runs, 1))
    pieces = np.where(runs < 0, -1, runs + n_runs * (examples.labels % n_groups))
    n_objects = int(examples.labels.max()) + 1
    parts = [NamedLeftOut(np.zeros(0), np.zeros((0, n_objects)), np.zeros(0, np.intp))]
    for learned, coordinates, labels in _without_readings(
        examples._replace(runs=pieces), manner.shrinkage, n_runs * n_groups
    ):
        means, of = _means_of_presses(coordinates, labels, n_presses)
        scores = learned.discriminant(manner)(means, n_presses)
        parts.append(NamedLeftOut(_squares(scores, manner.beyond), scores.unlikeliness, of))
    return NamedLeftOut(*map(np.concatenate, zip(*parts, strict=True)))


def _means_of_presses(coordinates: Array, labels: Labels, n_presses: int) -> tuple[Array, Labels]:
    """Return means of every so many successive readings of an object, (m, T), and whose."""
    means, of = [], []
    for k in np.unique(labels):
        own = coordinates[labels == k]
        n = len(own) // n_presses
        means.append(own[: n * n_presses].reshape(-1, n_presses, own.shape[1]).mean(axis=1))
        of.append(np.full(n, k, np.intp))
    return np.concatenate(means), np.concatenate(of)


def _squares(scores: Scores, beyond: float) -> Array:
    return scores.at(scores.unlikeliness.argmin(axis=1), beyond)


def _without_readings(
    examples: Examples, shrinkage: float, n_parts: int
) -> Iterator[tuple[Learned, Array, Labels]]:
    """Yield, for each part of the runs, what is learned of the others, and the part's readings."""
    for part in range(n_parts):
        out = (examples.runs >= 0) & (examples.runs % n_parts == part)
        if not out.any() or out.all():
            continue
        learned = Learned.of(examples.readings[~out], examples.labels[~out], shrinkage)
        yield learned, learned.located(examples.readings[out]), examples.labels[out]


def _without_objects(examples: Examples, shrinkage: float) -> Iterator[tuple[Learned, Array]]:
    """Yield, for each group of objects, what is learned of the others, and the group's readings."""
    for group in range(PARTS):
        out = examples.labels % PARTS == group
        kept = np.bincount(examples.labels[~out]) if out.any() else np.zeros(0)
        if np.count_nonzero(kept) < 2 or kept.max() < 2:
            continue
        others = examples.chosen(~out)
        learned = Learned.of(others.readings, others.labels, shrinkage)
        yield learned, learned.located(examples.readings[out])


def _tried(examples: Examples, shrinkage: float) -> Iterator[Tried]:
    """Yield what each manner of a shrinkage does."""
    of_readings = list(_without_readings(examples, shrinkage, PARTS))
    of_objects = list(_without_objects(examples, shrinkage))
    for variates, prior in product(VARIATES, PRIORS):
        manner = Manner(shrinkage, variates, prior)
        own: list[list[Array]] = [[np.zeros(0)] for _ in BEYOND]
        strangers: list[list[Array]] = [[np.zeros(0)] for _ in BEYOND]
        n_right, likelihood = 0, 0.0
        for learned, coordinates, labels in of_readings:
            scores = learned.discriminant(manner)(coordinates)
            n_right += int(np.count_nonzero(scores.unlikeliness.argmin(axis=1) == labels))
            likelihood += _log_likelihood(scores.unlikeliness, labels)
            for some, beyond in zip(own, BEYOND, strict=True):
                some.append(_squares(scores, beyond))
        for learned, coordinates in of_objects:
            scores = learned.discriminant(manner)(coordinates)
            for some, beyond in zip(strangers, BEYOND, strict=True):
                some.append(_squares(scores, beyond))
        yield Tried(manner, n_right, likelihood, [np.concatenate(some) for some in own],
                    [np.concatenate(some) for some in strangers])  # fmt: skip


def _log_likelihood(unlikeliness: Array, labels: Labels) -> float:
    """Return the log likelihood of the true objects, one surprise not counted beyond all."""
    logs = -0.5 * unlikeliness[np.arange(len(labels)), labels]
    return float(np.maximum(logs - logsumexp(-0.5 * unlikeliness, axis=1), -20.0).sum())
