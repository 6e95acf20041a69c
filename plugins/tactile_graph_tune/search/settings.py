"""Which values of the free settings are as good as the best, and which of these is taken.

Where values come to the same, what is least among them is so by chance. So of all that the frames
do not tell from the best the given one stays, and else the middle one is taken.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from tactile_graph_tune.search.front import Choice
from tactile_graph_tune.search.select import Rows
from tactile_graph_tune.search.weigher import GAIN
from tactile_graph_tune.split import interval_of
from tactile_graph_tune.table.kinds import Reals

Settings = Mapping[str, Any]
Sought = Callable[[Choice], tuple[Reals, Reals]]
"""Gives of each frame what is to be least, and how much the frame counts."""
AsGood = dict[str, tuple[Any, ...]]
"""For each free setting the values that are as good as the best, the others as chosen."""


def settled(
    best: Mapping[int, Choice],
    settings: Sequence[Settings],
    given: Settings,
    as_good: Callable[[Choice], bool],
) -> tuple[Choice, AsGood]:
    """Return the choice to be taken, and what would have been as good.

    Parameters
    ----------
    best : mapping of int to Choice
        For each variant that is allowed the choice that comes nearest to the goal.
    settings : sequence of mapping
        The values of each variant; none for the pipeline as it is.
    given : mapping
        The values that the pipeline has.
    as_good : callable
        Tells whether a choice is as good as the best of all.
    """
    values = {k: {**given, **settings[k]} for k, c in best.items() if as_good(c)}
    left = dict(values)
    for name in given:
        taken = given[name]
        if taken not in [its[name] for its in left.values()]:
            taken = _middle(its[name] for its in left.values())
        left = {k: its for k, its in left.items() if its[name] == taken}
    number, chosen = next(iter(left.items()))
    found = {
        name: tuple(
            dict.fromkeys(
                its[name]
                for its in values.values()
                if {**its, name: None} == {**chosen, name: None}
            )
        )
        for name in given
    }
    return best[number], found


def _middle(values: Iterable[Any]) -> Any:
    there = list(dict.fromkeys(values))
    if all(isinstance(v, int | float) for v in there):
        there.sort()
    return there[(len(there) - 1) // 2]


def best_of_each(
    chosen: Choice,
    others: Sequence[Choice],
    n_variants: int,
    allowed: Callable[[Choice], bool],
    sought: Callable[[Choice], float],
) -> dict[int, Choice]:
    """Return for each variant the best choice that may be taken, where there is one.

    Parameters
    ----------
    chosen : Choice
        What it asks is tried with every variant, too.
    others : sequence of Choice
    n_variants : int
    allowed, sought : callable
    """
    every = [chosen, *(replace(chosen, variant=k) for k in range(n_variants)), *others]
    found: dict[int, Choice] = {}
    for choice in filter(allowed, every):
        now = found.get(choice.variant)
        if now is None or sought(choice) < sought(now):
            found[choice.variant] = choice
    return dict(sorted(found.items()))


def told_from(best: Choice, sought: Sought, groups: Rows, seed: int) -> Callable[[Choice], bool]:
    """Return who tells whether a choice is as good as the best: not clearly more, paired.

    Parameters
    ----------
    best : Choice
    sought : callable
    groups : ndarray of int, shape (n_frames,)
        Frames of one group are drawn together.
    seed : int
    """
    least, weights = sought(best)
    slack = GAIN * float(np.average(least, weights=weights))

    def as_good(choice: Choice) -> bool:
        more = interval_of(weights * (sought(choice)[0] - least), groups, seed, weights)
        return more.low <= slack

    return as_good
