"""What may be taken of all that is weighed: what keeps every limit on either half of the frames.

A choice that is best on the frames it was searched by looks better than it is. So it has to keep
its limits on both halves of these frames, whole recordings on one side, and what it errs more than
the pipeline as it is, in the mean, has to lie a standard error below 0, or be 0 in every frame.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import inf
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import UsageError
from tactile_graph_tune.search.cascade import Predicted
from tactile_graph_tune.search.front import Choice
from tactile_graph_tune.table.kinds import SLACK, Means, Truths

Rows = NDArray[np.int64]
SURE = 1.0
"""Standard errors by which a choice has to be better than what it takes the place of."""

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
    may be no greater than that of the pipeline as given, and a time may be anything. Steps never
    fail in more frames.
    """

    time_us: float | None = None
    error: float | None = None
    missed: float | None = None
    false: float | None = None

    @property
    def by_time(self) -> bool:
        """Whether time is limited, and the least error sought."""
        return self.time_us is not None

    def limits(self, given: Means) -> Means:
        """Return what may not be exceeded on some frames, ``given`` being today's."""
        return Means(
            inf if self.time_us is None else self.time_us,
            inf if self.by_time else _said(self.error, given.error),
            _said(self.missed, given.missed),
            _said(self.false, given.false),
            float(given.failed),
        )

    def sought(self, means: Means) -> float:
        """Return what is to be least."""
        return float(means.error if self.by_time else means.time_us)


def _said(limit: float | None, own: Any) -> float:
    return float(own) if limit is None else limit


class Allowed:
    """Tells of choices whether they keep every limit.

    Parameters
    ----------
    goal : Goal
    truths : Truths
        Of the frames that choose.
    given : Predicted
        What the pipeline as given comes to in them.
    halves : sequence of ndarray of int64
        The frames in two halves.
    """

    def __init__(
        self, goal: Goal, truths: Truths, given: Predicted, halves: Sequence[Rows]
    ) -> None:
        self.goal, self.truths, self.given = goal, truths, given
        self.limits = goal.limits(given.means(truths))
        self._halves = [
            (rows, truths.taken(rows), goal.limits(given.taken(rows).means(truths.taken(rows))))
            for rows in halves
        ]

    def __call__(self, found: Predicted, by_time_too: bool = True) -> bool:
        """Return whether a choice keeps every limit on either half, surely that on its error.

        With ``by_time_too`` false only misses, false answers and failures count: what may stand on
        the front.
        """
        for rows, truths, limits in self._halves:
            most = limits if by_time_too else limits._replace(time_us=inf, error=inf)
            if not found.taken(rows).means(truths).within(most):
                return False
        return not by_time_too or self._surely(found)

    def _surely(self, found: Predicted) -> bool:
        """Return whether the error is no greater than as given, were other frames drawn, too."""
        if self.goal.by_time or self.goal.error is not None or not self.truths.full.any():
            return True
        more = (found.loss - self.given.loss)[self.truths.full]
        return bool(more.mean() + SURE * more.std() / np.sqrt(len(more)) <= SLACK)


def selected(
    allowed: Allowed, candidates: Sequence[Choice], predict: Callable[[Choice], Predicted]
) -> Choice:
    """Return the choice that comes nearest to the goal, of those within its limits.

    Parameters
    ----------
    allowed : Allowed
    candidates : sequence of Choice
        What was found, and what was there before.
    predict : callable
        Gives what a choice comes to in the frames that choose.

    Raises
    ------
    UsageError
        If none is within the limits.
    """
    best: tuple[float, Choice] | None = None
    every = []
    for choice in candidates:
        found = predict(choice)
        means = found.means(allowed.truths)
        every.append(means)
        if allowed(found):
            sought = allowed.goal.sought(means)
            if best is None or sought < best[0]:
                best = (sought, choice)
    if best is None:
        raise UsageError(_out_of_reach(allowed.goal, every))
    return best[1]


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
