"""The choices that none beats in both time and error, of those that are allowed."""

from __future__ import annotations

import bisect
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from tactile_graph_tune.choices.declared import Chosen
from tactile_graph_tune.search.cascade import Order
from tactile_graph_tune.table.kinds import Flags, Reals


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

    def enter(
        self, times_us: Reals, errors: Reals, allowed: Flags, choice: Callable[[int], Choice]
    ) -> None:
        """Enter choices by their means, shapes (n_choices,).

        Parameters
        ----------
        times_us, errors : ndarray of float64
        allowed : ndarray of bool
            Those not allowed are counted and no more.
        choice : callable
            Makes one by its number, if it is needed.
        """
        self.n_weighed += len(times_us)
        for k in sorted(np.flatnonzero(allowed), key=lambda k: (times_us[k], errors[k])):
            self._enter(float(times_us[k]), float(errors[k]), choice, int(k))

    def _enter(self, time_us: float, error: float, choice: Callable[[int], Choice], k: int) -> None:
        at = bisect.bisect_right(self.points, time_us, key=lambda p: p.time_us)
        if at and self.points[at - 1].error <= error:
            return
        end = at
        while end < len(self.points) and self.points[end].error >= error:
            end += 1
        if at and self.points[at - 1].time_us == time_us:
            at -= 1
        self.points[at:end] = [Weighed(time_us, error, choice(k))]
