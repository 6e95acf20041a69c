"""Choose only the numbers that guards compare with: what they ask, and the rungs, stay.

Every number of a choice is a dial: that of a comparison, or of one that an ``or`` joins. A search
turns one after the other while the others stay; resamples of the frames tell how surely each is
known.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from tactile_graph_tune.choices.comparisons import Comparison, alternatives, one_of_them
from tactile_graph_tune.choices.declared import Chosen
from tactile_graph_tune.search.cascade import Asked
from tactile_graph_tune.search.front import Choice
from tactile_graph_tune.search.questions import FINER, levels_between
from tactile_graph_tune.search.select import Goal, Rows
from tactile_graph_tune.search.weigher import GAIN, Aim, Space, Weigher
from tactile_graph_tune.table.columns import Table
from tactile_graph_tune.table.kinds import Flags, Means, Reals

ORDERED = ("<", "<=", ">", ">=")
"""Signs of a comparison whose number is a level: what must be equal has no other."""
MOST_SWEEPS = 4
RESAMPLES = 400
TAIL = 2.5
"""Percent of the resamples on either side of what a number lies between."""


@dataclass(frozen=True)
class Dial:
    """A number of a choice.

    Parameters
    ----------
    place : str
    at : int
        Which of the comparisons at the place.
    whole : Comparison
        That comparison.
    part : int
        Which of those that it joins by ``or``; 0 where it joins none.
    """

    place: str
    at: int
    whole: Comparison
    part: int

    @property
    def key(self) -> tuple[str, int, int]:
        """Where it stands."""
        return self.place, self.at, self.part

    @property
    def comparison(self) -> Comparison:
        """The comparison with the number."""
        return (alternatives(self.whole.field) or (self.whole,))[self.part]

    def turned(self, level: float) -> Comparison:
        """Return the whole comparison with another number."""
        parts = list(alternatives(self.whole.field))
        if not parts:
            return self.whole._replace(level=level)
        parts[self.part] = parts[self.part]._replace(level=level)
        return one_of_them(parts)

    def put(self, chosen: Chosen, level: float) -> Chosen:
        """Return what is chosen with another number."""
        its = list(chosen[self.place])
        its[self.at] = self.turned(level)
        return {**chosen, self.place: tuple(its)}


class Known(NamedTuple):
    """How surely a number is known, by resamples of the frames that choose.

    Parameters
    ----------
    comparison : Comparison
    low, high : float
        What the numbers lie between that are best, or as good as that, in 95 of 100 resamples, the
        other numbers as chosen.
    share : float
        Of the levels that there are to choose from, those that lie between.
    """

    comparison: Comparison
    low: float
    high: float
    share: float

    @property
    def text(self) -> str:
        """How surely, in words."""
        field, sign, _ = self.comparison
        return f"{field} {sign} {self.low:.3g} to {self.high:.3g} is as good"


def dials_of(chosen: Chosen) -> Iterator[Dial]:
    """Yield every number of a choice."""
    for place, comparisons in chosen.items():
        for at, whole in enumerate(comparisons):
            for part, its in enumerate(alternatives(whole.field) or (whole,)):
                if its.sign in ORDERED:
                    yield Dial(place, at, whole, part)


def levels_of(dial: Dial, table: Table) -> list[float]:
    """Return the numbers that a dial may be turned to, its own first."""
    own = dial.comparison
    values = table.column(own.field).values
    return list(dict.fromkeys([own.level, *levels_between(values[~np.isnan(values)], FINER)]))


def asked_by(dial: Dial, table: Table, levels: Sequence[float]) -> Asked:
    """Return a dial's comparison at some levels, side by side."""
    own = dial.whole
    turned = [Asked.of(dial.turned(level), table) for level in levels]
    return Asked(own.field, own.node, np.stack([t.holds for t in turned]), turned[0].time_us)


class LevelSearch(Weigher):
    """Fills a front with what other numbers in the same guards come to."""

    def run(self) -> None:
        """Turn every dial for every aim."""
        given = self.space.given
        self.weigh(given.order, given.chosen)
        for aim in self.aims:
            for _ in range(MOST_SWEEPS):
                before, chosen = self.best[given.order, aim]
                for dial in list(dials_of(chosen)):
                    self._turn(dial.place, dial.at, dial.part, aim)
                if self.best[given.order, aim][0] > before * (1.0 - GAIN):
                    break

    def _turn(self, place: str, at: int, part: int, aim: Aim) -> None:
        order = self.space.given.order
        _, chosen = self.best[order, aim]
        dial = Dial(place, at, chosen[place][at], part)
        levels = levels_of(dial, self.space.table)
        asked = {place: [asked_by(dial, self.space.table, levels)]}
        made = [partial(dial.put, chosen, level) for level in levels]
        self.weigh(order, without(chosen, dial), asked, made)


def without(chosen: Chosen, dial: Dial) -> Chosen:
    """Return what is chosen but for the comparison that a dial is a part of."""
    its = chosen[dial.place]
    return {**chosen, dial.place: (*its[: dial.at], *its[dial.at + 1 :])}


class Resamples:
    """Tells how surely numbers are known.

    Parameters
    ----------
    spaces : sequence of Space
        Of the frames that choose, one a variant.
    goal : Goal
    over_us : float
        What a whole unit over a limit costs.
    groups : ndarray of int, shape (n_frames,)
        Frames of one group are drawn together.
    seed : int
    """

    def __init__(
        self, spaces: Sequence[Space], goal: Goal, over_us: float, groups: Rows, seed: int
    ) -> None:
        self._spaces, self._goal = spaces, goal
        self._draws = _draws(groups, seed)
        given = _drawn(spaces[goal.given.variant], goal.given, {}, self._draws)
        self._aim = Aim(0.0, goal.limits_of(given), over_us)

    def known(self, choice: Choice, dial: Dial) -> Known | None:
        """Return how surely a number of a choice is known; None where there is no other."""
        space = self._spaces[choice.variant]
        levels = levels_of(dial, space.table)
        if len(levels) < 2:
            return None
        asked = {dial.place: [asked_by(dial, space.table, levels)]}
        bare = replace(choice, chosen=without(choice.chosen, dial))
        means = _drawn(space, bare, asked, self._draws)
        sought = means.error if self._goal.by_time else means.time_us
        objective = self._aim.over(means) + sought
        as_good = objective <= objective.min(axis=0) * (1.0 + GAIN)
        of = np.array(levels)[:, None]
        lows = np.where(as_good, of, np.inf).min(axis=0)
        highs = np.where(as_good, of, -np.inf).max(axis=0)
        low = float(np.percentile(lows, TAIL, method="nearest"))
        high = float(np.percentile(highs, 100.0 - TAIL, method="nearest"))
        between = [level for level in levels if low <= level <= high]
        return Known(dial.comparison, low, high, len(between) / len(levels))

    def of_all(self, choice: Choice) -> list[tuple[str, Known]]:
        """Return for each number of a choice, with its place, how surely it is known."""
        found = ((dial.place, self.known(choice, dial)) for dial in dials_of(choice.chosen))
        return [(place, its) for place, its in found if its is not None]


def unchanged_where_as_good(
    choice: Choice,
    given: Chosen,
    known: Callable[[Choice, Dial], Known | None],
    allowed: Callable[[Choice], bool],
) -> Choice:
    """Return a choice with every number as it was given that the frames do not speak against.

    Parameters
    ----------
    choice : Choice
        Of the same guards as ``given``, with other numbers.
    given : mapping
    known : callable
        Gives how surely a number of a choice is known.
    allowed : callable
        Tells whether a choice may be taken.
    """
    for old in dials_of(given):
        new = next(d for d in dials_of(choice.chosen) if d.key == old.key)
        level = old.comparison.level
        its = known(choice, new)
        if its is None or its.low <= level <= its.high:
            back = replace(choice, chosen=new.put(choice.chosen, level))
            choice = back if allowed(back) else choice
    return choice


class _Draws(NamedTuple):
    """Resamples: to which group each frame belongs, and how often each group is drawn."""

    at: Rows
    times: Reals


def _draws(groups: Rows, seed: int) -> _Draws:
    at = np.unique(groups, return_inverse=True)[1].astype(np.int64)
    n = int(at.max()) + 1
    rng = np.random.default_rng([seed, 11])
    return _Draws(at, rng.multinomial(n, np.full(n, 1.0 / n), RESAMPLES).astype(float))


def _drawn(space: Space, choice: Choice, more: dict[str, list[Asked]], draws: _Draws) -> Means:
    """Return the means of choices in every resample, each of shape (n_choices, n_resamples)."""
    table = space.table
    asked = {p: [Asked.of(c, table) for c in cs] for p, cs in choice.chosen.items()}
    for place, questions in more.items():
        asked[place] = [*asked.get(place, ()), *questions]
    found = space.cascade(table, choice.order, asked)
    n = max((q.holds.shape[0] for qs in more.values() for q in qs), default=1)
    time_us, loss, _, failed = found.spread((n, table.n))
    truths = table.truths
    all_ = np.ones(table.n, np.bool_)
    kinds = [(time_us, all_), *((its, of) for _, its, of in truths.parts(loss)), (failed, all_)]

    def mean(its: Any, of: Flags) -> Reals:
        weights = truths.weights
        sums = np.stack([np.bincount(draws.at, row * weights) for row in its])
        n_of = draws.times @ np.bincount(draws.at, of * weights)
        means: Reals = (sums @ draws.times.T) / np.maximum(n_of, 1e-12)
        return means

    return Means(*(mean(its, of) for its, of in kinds))
