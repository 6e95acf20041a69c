"""Which of all that was found is taken: what holds on frames that the search did not see either.

A choice that is best on the frames it was searched by looks better than it is. So the frames that
choose are halved, whole recordings on one side: what one half finds has to hold on the other.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from tactile_graph.errors import UsageError
from tactile_graph_tune.search.cascade import Predicted
from tactile_graph_tune.search.front import Choice, Front

Predict = Callable[[Choice], Predicted]
Rows = Any


@dataclass(frozen=True)
class Goal:
    """What is sought: the cheapest within an error, or with ``by_time`` the best within a time.

    ``allowed`` is None for an error no greater than that of the ``references``.
    """

    allowed: float | None
    by_time: bool
    references: tuple[Choice, ...]

    def limited(self, means: Means) -> float:
        """Return what is limited."""
        return means.time_us if self.by_time else means.loss

    def sought(self, means: Means) -> float:
        """Return what is to be least."""
        return means.loss if self.by_time else means.time_us


class Means(NamedTuple):
    """Mean time and mean error over some frames."""

    time_us: float
    loss: float


def selected(
    goal: Goal, fronts: Sequence[Front], folds: Sequence[Rows], predict: Predict
) -> Choice:
    """Return the choice that comes nearest to the goal within what is allowed on either half.

    Parameters
    ----------
    goal : Goal
    fronts : sequence of Front
        What each half found.
    folds : sequence of ndarray of int64
        The rows of each half.
    predict : callable
        Gives what a choice comes to in every frame.

    Raises
    ------
    UsageError
        If none is within what is allowed.
    """
    limits = [limit_of(goal, rows, predict) for rows in folds]
    candidates = [*goal.references, *(p.choice for front in fronts for p in front.points)]
    both = np.concatenate(list(folds))
    best: tuple[float, Choice] | None = None
    nearest = np.inf
    for choice in candidates:
        found = predict(choice)
        limited = [goal.limited(_means(found, rows)) for rows in folds]
        nearest = min(nearest, max(limited))
        if all(x <= limit for x, limit in zip(limited, limits, strict=True)):
            sought = goal.sought(_means(found, both))
            if best is None or sought < best[0]:
                best = (sought, choice)
    if best is None:
        raise UsageError(_out_of_reach(goal, nearest))
    return best[1]


def limit_of(goal: Goal, rows: Rows, predict: Predict) -> float:
    """Return what is allowed on some frames."""
    if goal.allowed is not None:
        return goal.allowed
    return min(goal.limited(_means(predict(c), rows)) for c in goal.references)


def merged(fronts: Sequence[Front], rows: Rows, predict: Predict) -> Front:
    """Return the front of all that was found, by all the frames that choose."""
    whole = Front()
    choices = [p.choice for front in fronts for p in front.points]
    means = [_means(predict(c), rows) for c in choices]
    times, losses = np.array(means).reshape(-1, 2).T
    whole.enter(times, losses, lambda k: choices[k])
    whole.n_weighed = sum(front.n_weighed for front in fronts)
    return whole


def _means(found: Predicted, rows: Rows) -> Means:
    return Means(float(found.time_us[rows].mean()), float(found.loss[rows].mean()))


def _out_of_reach(goal: Goal, nearest: float) -> str:
    if goal.by_time:
        return (
            f"--time-at-most {goal.allowed:g}: the cheapest choice takes {nearest:.3g} µs a frame"
        )
    return f"--error-at-most {goal.allowed:g}: the best choice has a mean error of {nearest:.3g}"
