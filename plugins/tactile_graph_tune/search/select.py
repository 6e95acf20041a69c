"""Which of all that was found is taken: what holds on frames that the search did not see either.

A choice that is best on the frames it was searched by looks better than it is. So the frames that
choose are halved, whole recordings on one side: what one half finds has to hold on the other.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import inf
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import UsageError
from tactile_graph_tune.search.front import Choice, Front
from tactile_graph_tune.table.kinds import Means

Rows = NDArray[np.int64]
Weigh = Callable[[Choice, Rows], Means]
"""Gives the means of a choice over some frames."""

OPTIONS = {
    "time_us": ("--time-at-most", "the cheapest choice takes {:.3g} µs a frame"),
    "error": ("--error-at-most", "the best choice has a mean error of {:.3g}"),
    "missed": ("--missed-at-most", "the choice that misses least misses {:.3g}"),
    "false": ("--false-at-most", "the choice that answers least on empty pads answers {:.3g}"),
}


@dataclass(frozen=True)
class Goal:
    """What is sought: the cheapest within limits on error, or the best within one on time.

    Each is None where it was not said: then an error, a share of misses, or one of false answers
    may be no greater than ``given``'s, and a time may be anything. Steps never fail in more frames.
    ``margin`` is the share by which the error may be greater all the same.
    """

    given: Choice
    time_us: float | None = None
    error: float | None = None
    missed: float | None = None
    false: float | None = None
    margin: float = 0.0

    @property
    def by_time(self) -> bool:
        """Whether time is limited, and the least error sought."""
        return self.time_us is not None

    def limits(self, rows: Rows, weigh: Weigh) -> Means:
        """Return what may not be exceeded on some frames."""
        return self.limits_of(weigh(self.given, rows))

    def limits_of(self, own: Means) -> Means:
        """Return what may not be exceeded where the pipeline as given comes to ``own``."""
        return Means(
            inf if self.time_us is None else self.time_us,
            inf if self.by_time else _said(self.error, (1.0 + self.margin) * own.error),
            _said(self.missed, own.missed),
            _said(self.false, own.false),
            own.failed,
        )

    def sought(self, means: Means) -> float:
        """Return what is to be least."""
        return float(means.error if self.by_time else means.time_us)


def _said(limit: float | None, own: Any) -> Any:
    return own if limit is None else limit


def selected(
    goal: Goal, candidates: Sequence[Choice], folds: Sequence[Rows], weigh: Weigh
) -> Choice:
    """Return the choice that comes nearest to the goal, of those within its limits on either half.

    Parameters
    ----------
    goal : Goal
    candidates : sequence of Choice
        What the halves found, and what was there before.
    folds : sequence of ndarray of int64
        The rows of each half.
    weigh : callable

    Raises
    ------
    UsageError
        If none is within the limits.
    """
    limits = [goal.limits(rows, weigh) for rows in folds]
    both = np.concatenate(list(folds))
    best: tuple[float, Choice] | None = None
    found = []
    for choice in candidates:
        means = [weigh(choice, rows) for rows in folds]
        found.append(Means(*np.max(means, axis=0)))
        if all(m.within(most) for m, most in zip(means, limits, strict=True)):
            sought = goal.sought(weigh(choice, both))
            if best is None or sought < best[0]:
                best = (sought, choice)
    if best is None:
        raise UsageError(_out_of_reach(goal, found))
    return best[1]


def merged(
    fronts: Sequence[Front], choices: Sequence[Choice], rows: Rows, weigh: Weigh, limits: Means
) -> Front:
    """Return the front of all that was found, by all the frames that choose.

    Only misses and false answers are limited on it.
    """
    whole = Front()
    means = Means(*np.array([weigh(c, rows) for c in choices]).T)
    allowed = means.within(limits._replace(time_us=inf, error=inf))
    whole.enter(means.time_us, means.error, allowed, lambda k: choices[k])
    whole.n_weighed = sum(front.n_weighed for front in fronts)
    return whole


def _out_of_reach(goal: Goal, found: Sequence[Means]) -> str:
    """Return which limit is out of reach by itself, or else that all are together."""
    said = {name: getattr(goal, name) for name in OPTIONS if getattr(goal, name) is not None}
    for name, most in said.items():
        nearest = min(float(getattr(m, name)) for m in found)
        if nearest > most:
            option, words = OPTIONS[name]
            return f"{option} {most:g}: {words.format(nearest)}"
    told = " ".join(f"{OPTIONS[name][0]} {most:g}" for name, most in said.items())
    return (
        f"{told}: no choice keeps it and errs, misses and answers on empty pads no more than the "
        "pipeline as it is on both halves of the frames; --error-at-most, --missed-at-most and "
        "--false-at-most allow more"
    )
