"""Search guards and orders: one place after the other, for one price of error after the other.

Time and error are weighed as time + price * error, as budgeted prediction does (Xu, Weinberger and
Chapelle 2012, "The greedy miser"); comparisons that stop early are Viola and Jones' attentional
cascade (2001, 10.1109/CVPR.2001.990517). What goes beyond the limits on misses and false answers
costs more than anything that could be gained by it. For each aim and each order every place in turn
takes the comparison that is best while the others stay, from the best that any other aim found.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, permutations

import numpy as np

from tactile_graph_tune.choices.comparisons import Comparison
from tactile_graph_tune.choices.declared import Chosen
from tactile_graph_tune.search.cascade import Asked, Cascade, Order
from tactile_graph_tune.search.front import Choice, Front
from tactile_graph_tune.search.questions import Batch, Questions
from tactile_graph_tune.table.columns import Table
from tactile_graph_tune.table.kinds import Means, Reals

MOST_ASKED = 2
"""Comparisons at one place."""
GAIN = 0.003
"""Share of the objective that one comparison more has to bring."""
MOST_SWEEPS = 2
ALL_ORDERS = 3
"""Rungs up to which every order is tried; of more, only those from cheap to dear."""


@dataclass(frozen=True)
class Space:
    """What is searched, and by which frames."""

    variant: int
    cascade: Cascade
    table: Table
    questions: Questions
    given: Choice


@dataclass(frozen=True)
class Aim:
    """What one descent makes least: time + price * error, far more for what is over its limits.

    Parameters
    ----------
    price : float
        Of error: µs per unit.
    limits : Means
    over_us : float
        Of a whole unit over a limit.
    """

    price: float
    limits: Means
    over_us: float

    def of(self, means: Means) -> Reals:
        """Return what is to be least, shape (n_choices,)."""
        over = sum(
            np.maximum(0.0, mine - most)
            for mine, most in zip(means[1:], self.limits[1:], strict=True)
        )
        found: Reals = means.time_us + self.price * means.error + self.over_us * over
        return found


class Search:
    """Fills a front.

    Parameters
    ----------
    space : Space
    front : Front
    aims : sequence of Aim
    limits : Means
        What a choice on the front may not exceed.
    """

    def __init__(self, space: Space, front: Front, aims: Sequence[Aim], limits: Means) -> None:
        self.space, self.front, self.aims, self.limits = space, front, aims, limits
        self._best: dict[tuple[Order, Aim], tuple[float, Chosen]] = {}

    def run(self, orders: Sequence[Order]) -> None:
        """Search with each of the orders of rungs."""
        given = self.space.given.chosen
        starts: list[Chosen] = [{}, given]
        for order in orders:
            for start in starts:
                self._weigh(order, start, {}, [()])
            for aim in self.aims:
                self._descend(order, aim)

    def _descend(self, order: Order, aim: Aim) -> None:
        """Improve the best choice for an aim, place by place, until none gets better."""
        for _ in range(MOST_SWEEPS):
            before, _ = self._best[order, aim]
            for place in self.space.questions.fields:
                if self._live(place, order):
                    self._improve(order, aim, place)
            if self._best[order, aim][0] > before * (1.0 - GAIN):
                return

    def _live(self, place: str, order: Order) -> bool:
        """Return whether anything is asked at a place: the last rung answers whatever it has."""
        rungs = self.space.given.order
        return place not in rungs or place in order[:-1]

    def _improve(self, order: Order, aim: Aim, place: str) -> None:
        _, chosen = self._best[order, aim]
        now = chosen.get(place, ())
        bases = dict.fromkeys([(), *((c,) for c in now)])
        self._weigh(order, {**chosen, place: ()}, {}, [()])
        for base in bases:
            for field in self.space.questions.fields[place]:
                if any(c.field == field for c in base) and len(base) == MOST_ASKED:
                    continue
                finer = any(c.field == field for c in now)
                batch = self.space.questions.batch(field, finer)
                if batch is not None:
                    self._weigh_batch(order, {**chosen, place: base}, place, batch)

    def _weigh_batch(self, order: Order, chosen: Chosen, place: str, batch: Batch) -> None:
        asked = {place: [batch.asked]}
        self._weigh(order, chosen, asked, [(place, c) for c in batch.comparisons])

    def _weigh(
        self,
        order: Order,
        chosen: Chosen,
        more: dict[str, list[Asked]],
        added: Sequence[tuple[()] | tuple[str, Comparison]],
    ) -> None:
        """Weigh a choice, or many that each have one comparison added."""
        table = self.space.table
        asked = {p: [Asked.of(c, table) for c in cs] for p, cs in chosen.items()}
        for place, questions in more.items():
            asked[place] = [*asked.get(place, ()), *questions]
        found = self.space.cascade(table, order, asked)
        means = found.spread((len(added), table.n)).means(table.truths)
        made: dict[int, Chosen] = {}

        def chosen_at(k: int) -> Chosen:
            if k not in made:
                made[k] = _with(chosen, *added[k])
            return made[k]

        variant = self.space.variant
        self.front.enter(
            means.time_us, means.error, means.within(self.limits),
            lambda k: Choice(variant, order, chosen_at(k)),
        )  # fmt: skip
        self._note(order, means, chosen_at, sum(map(len, chosen.values())) + len(more))

    def _note(
        self, order: Order, means: Means, chosen_at: Callable[[int], Chosen], n_asked: int
    ) -> None:
        for aim in self.aims:
            objective = aim.of(means) * (1.0 + GAIN * n_asked)
            k = int(objective.argmin())
            known = self._best.get((order, aim), (math.inf, {}))
            if objective[k] < known[0]:
                self._best[order, aim] = (float(objective[k]), chosen_at(k))


def _with(chosen: Chosen, place: str = "", comparison: Comparison | None = None) -> Chosen:
    found = {p: cs for p, cs in chosen.items() if cs}
    if comparison is not None:
        found[place] = (*found.get(place, ()), comparison)
    return found


def orders_of(rungs: Order, mean_us: Sequence[float]) -> list[Order]:
    """Return the orders of rungs to try: the given one, and others, rungs left out too.

    Parameters
    ----------
    rungs : tuple of str
        In the given order.
    mean_us : sequence of float
        What each takes alone.
    """
    if not rungs:
        return [()]
    cheap_first = sorted(range(len(rungs)), key=lambda k: mean_us[k])
    found: Iterator[tuple[int, ...]]
    if len(rungs) <= ALL_ORDERS:
        sizes = range(1, len(rungs) + 1)
        found = (o for n in sizes for o in permutations(range(len(rungs)), n))
    else:
        sizes = range(1, len(rungs) + 1)
        found = (o for n in sizes for o in combinations(cheap_first, n))
    return list(dict.fromkeys([rungs, *(tuple(rungs[k] for k in o) for o in found)]))


def pruned(space: Space, choice: Choice, limits: Means, by_time: bool = False) -> Choice:
    """Return a choice without the comparisons that bring next to nothing.

    Parameters
    ----------
    space : Space
    choice : Choice
    limits : Means
        Over the frames of the space.
    by_time : bool
        Whether the error is to be least, not the time.
    """
    best = _means(space, choice)
    for place, comparisons in choice.chosen.items():
        for comparison in comparisons:
            left = tuple(c for c in choice.chosen[place] if c != comparison)
            simpler = replace(choice, chosen={**choice.chosen, place: left})
            found = _means(space, simpler)
            sought, most = (m.error if by_time else m.time_us for m in (found, best))
            if found.within(limits) and sought <= most * (1.0 + 2.0 * GAIN):
                choice, best = simpler, found
    return replace(choice, chosen={p: cs for p, cs in choice.chosen.items() if cs})


def _means(space: Space, choice: Choice) -> Means:
    found = space.cascade.predicted(space.table, choice.order, choice.chosen)
    return found.means(space.table.truths)
