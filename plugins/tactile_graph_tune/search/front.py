"""The choices that none beats in both time and error, of those that are allowed."""

from __future__ import annotations

import bisect
from collections.abc import Callable
from dataclasses import dataclass, field

from tactile_graph_tune.choices.declared import Chosen
from tactile_graph_tune.search.cascade import Order
from tactile_graph_tune.table.kinds import Means


@dataclass(frozen=True)
class Choice:
    """An order of the rungs, and what is asked at each place.

    ``variant`` is the number of the free settings' values.
    """

    variant: int
    order: Order
    chosen: Chosen


@dataclass(frozen=True)
class Weighed:
    """A choice with its mean time and mean error on the frames it was chosen by."""

    time_us: float
    error: float
    choice: Choice


Made = Callable[[int], Choice]


@dataclass
class Front:
    """The Pareto front of all that was weighed, by time; the error falls along it.

    Attributes
    ----------
    n_weighed : int
        Choices that were weighed.
    """

    points: list[Weighed] = field(default_factory=list)
    n_weighed: int = 0

    def enter(self, means: Means, allowed: Callable[[int], bool], choice: Made) -> None:
        """Enter choices by their means, of shape (n_choices,).

        Parameters
        ----------
        means : Means
        allowed : callable
            Whether one may stand on the front, by its number; asked only of what would.
        choice : callable
            Makes one by its number, if it is needed.
        """
        times, errors = means.time_us, means.error
        self.n_weighed += len(times)
        for k in sorted(range(len(times)), key=lambda k: (times[k], errors[k])):
            time_us, error = float(times[k]), float(errors[k])
            if not self.beats(time_us, error) and allowed(k):
                self._enter(Weighed(time_us, error, choice(k)))

    def beats(self, time_us: float, error: float) -> bool:
        """Return whether something on the front is as good in both."""
        at = bisect.bisect_right(self.points, time_us, key=lambda p: p.time_us)
        return bool(at) and self.points[at - 1].error <= error

    def _enter(self, new: Weighed) -> None:
        time_us, error = new.time_us, new.error
        at = bisect.bisect_right(self.points, time_us, key=lambda p: p.time_us)
        end = at
        while end < len(self.points) and self.points[end].error >= error:
            end += 1
        if at and self.points[at - 1].time_us == time_us:
            at -= 1
        self.points[at:end] = [new]
