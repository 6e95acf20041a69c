"""What tuning found."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

from tactile_graph import Pipeline
from tactile_graph_tune.choices.comparisons import Comparison
from tactile_graph_tune.search.front import Choice
from tactile_graph_tune.search.levels import Known
from tactile_graph_tune.search.oracle import Bound
from tactile_graph_tune.search.settings import AsGood
from tactile_graph_tune.split import Interval
from tactile_graph_tune.table.record import Judged

GIVEN, ALWAYS, CHOSEN = "as given", "always the best", "tuned"

NOTHING_SAVED = 1e-3
"""Share of a time below which what an oracle saves of it is rounding and no saving."""


class Weight(NamedTuple):
    """The means of `Means`, each with its interval; of no frame, NaN."""

    time_us: Interval
    error: Interval
    missed: Interval
    false: Interval

    def told(self, unit: str) -> str:
        """Return how much more of each kind of error there is, in words."""
        off = self.error
        told = f"error {off.mean:+.2g} {unit}".rstrip() + f" ({off.low:+.2g} to {off.high:+.2g})"
        shares = (("missed", self.missed), ("false on empty", self.false))
        named = (f", {n} {100 * its.mean:+.2g} %" for n, its in shares if its.mean == its.mean)
        return told + "".join(named)


@dataclass(frozen=True)
class Point:
    """A choice, by the table on the frames it was not chosen by, and run on them."""

    label: str
    choice: Choice
    weight: Weight
    rerun: Weight | None = None


@dataclass(frozen=True)
class GuardWorth:
    """What the comparisons at one place save and cost, on the frames they were not chosen by.

    Parameters
    ----------
    place : str
    comparisons : tuple of Comparison
    n_stopped : int
        Frames in which it kept something from running.
    saved_share : float
        Time a frame takes less with it, as a share of that without.
    cost : Weight
        What is more with it: time, error where something lies, shares missed and false.
    rivals : tuple of (Comparison, float, float)
        The best other fields at this place: the comparison, mean time and mean error with it.
    known : tuple of Known
        How surely its numbers are known.
    """

    place: str
    comparisons: tuple[Comparison, ...]
    n_stopped: int
    saved_share: float
    cost: Weight
    rivals: tuple[tuple[Comparison, float, float], ...]
    known: tuple[Known, ...] = ()


@dataclass(frozen=True, eq=False)
class Tuned:
    """The outcome of tuning; all numbers are of the frames that were not chosen by.

    Parameters
    ----------
    judged : Judged
    n_choosing, n_reporting : int
        Frames.
    how : str
        How they were told apart.
    n_weighed : int
        Choices that were weighed.
    points : dict of Point
        As given, always the best rung, and tuned.
    front : tuple of Point
        What no other choice beat on the frames that were chosen by.
    bound : Bound
        The least that any choice could reach.
    everything_us : float
        Mean time of a frame in which nothing is skipped.
    worths : tuple of GuardWorth
    settings : mapping
        What was chosen of the free settings.
    as_good : mapping
        For each of them the values that are as good, the others as chosen.
    ratio : Interval
        The tuned time over the given one.
    difference : Weight
        Tuned less given.
    saved : Interval
        What a frame in which nothing is skipped takes more than a tuned one, µs, predicted.
    pipeline : Pipeline
        The tuned one.
    text : str
        Its file.
    """

    judged: Judged
    n_choosing: int
    n_reporting: int
    how: str
    n_weighed: int
    points: dict[str, Point]
    front: tuple[Point, ...]
    bound: Bound
    everything_us: float
    worths: tuple[GuardWorth, ...]
    settings: dict[str, Any]
    as_good: AsGood
    ratio: Interval
    difference: Weight
    saved: Interval
    pipeline: Pipeline
    text: str

    def oracle_us(self, label: str = CHOSEN) -> float:
        """Return what an oracle takes that errs and misses no more than a point does."""
        own = self.points[label].weight
        return self.bound.time_at(own.error.mean, own.missed.mean)

    def share_of_saving(self, label: str = CHOSEN, over_us: float | None = None) -> float:
        """Return how much of what an oracle saves at equal error a point saves.

        NaN where no oracle errs as little, or the oracle saves less than `NOTHING_SAVED`.

        Parameters
        ----------
        label : str
        over_us : float, optional
            The time that is saved against; that of skipping nothing if not given.
        """
        whole = self.everything_us if over_us is None else over_us
        own, least = self.points[label].weight.time_us.mean, self.oracle_us(label)
        saved = whole - least
        return (whole - own) / saved if saved > NOTHING_SAVED * whole else float("nan")
