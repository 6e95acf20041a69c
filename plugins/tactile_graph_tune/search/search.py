"""Search guards and orders: one place after the other, for one price of error after the other.

Time and error are weighed as time + price * error, as budgeted prediction does (Xu, Weinberger and
Chapelle 2012, "The greedy miser"); comparisons that stop early are Viola and Jones' attentional
cascade (2001, 10.1109/CVPR.2001.990517). What goes beyond the limits on misses and false answers
costs more than anything that could be gained by it. For each aim and each order every place in turn
takes the comparison that is best while the others stay, from the best that any other aim found.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from itertools import combinations, permutations

from tactile_graph_tune.choices.comparisons import Comparison
from tactile_graph_tune.choices.declared import Chosen
from tactile_graph_tune.search.cascade import Order
from tactile_graph_tune.search.front import Choice
from tactile_graph_tune.search.questions import Batch
from tactile_graph_tune.search.weigher import GAIN, Aim, Space, Weigher
from tactile_graph_tune.table.kinds import Means

MOST_ASKED = 2
"""Comparisons at one place."""
MOST_SWEEPS = 2
ALL_ORDERS = 3
"""Rungs up to which every order is tried; of more, only those from cheap to dear."""


class Search(Weigher):
    """Fills a front with guards and orders."""

    def run(self, orders: Sequence[Order]) -> None:
        """Search with each of the orders of rungs."""
        given = self.space.given.chosen
        starts: list[Chosen] = [{}, given]
        for order in orders:
            for start in starts:
                self.weigh(order, start)
            for aim in self.aims:
                self._descend(order, aim)

    def _descend(self, order: Order, aim: Aim) -> None:
        """Improve the best choice for an aim, place by place, until none gets better."""
        for _ in range(MOST_SWEEPS):
            before, _ = self.best[order, aim]
            for place in self.space.questions.fields:
                if self._live(place, order):
                    self._improve(order, aim, place)
            if self.best[order, aim][0] > before * (1.0 - GAIN):
                return

    def _live(self, place: str, order: Order) -> bool:
        """Return whether anything is asked at a place: the last rung answers whatever it has."""
        rungs = self.space.given.order
        return place not in rungs or place in order[:-1]

    def _improve(self, order: Order, aim: Aim, place: str) -> None:
        _, chosen = self.best[order, aim]
        now = chosen.get(place, ())
        bases = dict.fromkeys([(), *((c,) for c in now)])
        self.weigh(order, {**chosen, place: ()})
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
        self.weigh(
            order, chosen, asked, [partial(_with, chosen, place, c) for c in batch.comparisons]
        )


def _with(chosen: Chosen, place: str, comparison: Comparison) -> Chosen:
    return {**chosen, place: (*chosen.get(place, ()), comparison)}


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
