"""What tuning found."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

from tactile_graph import Pipeline
from tactile_graph_tune.choices.comparisons import Comparison
from tactile_graph_tune.search.front import Choice
from tactile_graph_tune.search.oracle import Bound
from tactile_graph_tune.split import Interval
from tactile_graph_tune.table.record import Judged

GIVEN, ALWAYS, CHOSEN = "as given", "always the best", "tuned"


class Weight(NamedTuple):
    """Mean time and mean error, each with its interval."""

    time_us: Interval
    loss: Interval


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
    saved_us : Interval
        Mean time a frame takes more without it.
    saved_share : float
        The same as a share of the time without it.
    cost : Interval
        Mean error a frame has more with it.
    rivals : tuple of (Comparison, float, float)
        The best other fields at this place: the comparison, mean time and mean error with it.
    """

    place: str
    comparisons: tuple[Comparison, ...]
    n_stopped: int
    saved_us: Interval
    saved_share: float
    cost: Interval
    rivals: tuple[tuple[Comparison, float, float], ...]


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
    ratio, difference : Interval
        The tuned time over the given one, and the tuned error less the given one.
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
    ratio: Interval
    difference: Interval
    pipeline: Pipeline
    text: str

    def share_of_saving(self, label: str = CHOSEN) -> float:
        """Return how much of what an oracle saves at equal error a point saves."""
        whole, own = self.everything_us, self.points[label].weight
        least = self.bound.time_at(own.loss.mean)
        return (whole - own.time_us.mean) / (whole - least) if whole > least else float("nan")
