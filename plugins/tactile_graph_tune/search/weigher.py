"""What is searched, what is sought, and what a choice, or many at once, come to."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from tactile_graph_tune.choices.declared import Chosen
from tactile_graph_tune.search.cascade import Asked, Cascade, Order
from tactile_graph_tune.search.front import Choice, Front
from tactile_graph_tune.search.questions import Questions
from tactile_graph_tune.table.columns import Table
from tactile_graph_tune.table.kinds import Means, Reals

GAIN = 0.003
"""Share of the objective that one comparison more has to bring."""


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
        found: Reals = means.time_us + self.price * means.error + self.over(means)
        return found

    def over(self, means: Means) -> Reals:
        """Return what being over the limits costs."""
        over = sum(
            np.maximum(0.0, mine - most)
            for mine, most in zip(means[1:], self.limits[1:], strict=True)
        )
        found: Reals = self.over_us * over
        return found


class Weigher:
    """Fills a front, and keeps what is best for each aim.

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
        self.best: dict[tuple[Order, Aim], tuple[float, Chosen]] = {}

    def weigh(
        self,
        order: Order,
        chosen: Chosen,
        more: dict[str, list[Asked]] | None = None,
        made: Sequence[Callable[[], Chosen]] = (),
    ) -> None:
        """Weigh a choice, or many that each have one comparison more; ``made`` tells which."""
        table = self.space.table
        asked = {p: [Asked.of(c, table) for c in cs] for p, cs in chosen.items()}
        for place, questions in (more or {}).items():
            asked[place] = [*asked.get(place, ()), *questions]
        found = self.space.cascade(table, order, asked)
        means = found.spread((max(1, len(made)), table.n)).means(table.truths)
        known: dict[int, Chosen] = {}

        def chosen_at(k: int) -> Chosen:
            if k not in known:
                known[k] = {p: cs for p, cs in (made[k]() if made else chosen).items() if cs}
            return known[k]

        variant = self.space.variant
        self.front.enter(
            means.time_us, means.error, means.within(self.limits),
            lambda k: Choice(variant, order, chosen_at(k)),
        )  # fmt: skip
        self._note(order, means, chosen_at, sum(map(len, chosen.values())) + len(more or {}))

    def _note(
        self, order: Order, means: Means, chosen_at: Callable[[int], Chosen], n_asked: int
    ) -> None:
        for aim in self.aims:
            objective = aim.of(means) * (1.0 + GAIN * n_asked)
            k = int(objective.argmin())
            known = self.best.get((order, aim), (math.inf, {}))
            if objective[k] < known[0]:
                self.best[order, aim] = (float(objective[k]), chosen_at(k))
