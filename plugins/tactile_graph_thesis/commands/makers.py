"""``Makers``: who makes the items and writes their files, this process or workers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import groupby
from typing import TYPE_CHECKING, NamedTuple

from tactile_graph.many import KILLER, Sharing
from tactile_graph_thesis.commands.targets import Targets
from tactile_graph_thesis.item import Item, Made
from tactile_graph_thesis.making import Outcome, outcomes
from tactile_graph_thesis.work import Work

if TYPE_CHECKING:
    from tactile_graph.many import Place, Portion


class Written(NamedTuple):
    """An item's outcome, its figure written and let go; and that as SVG, for the book."""

    outcome: Outcome
    svg: bytes | None


class Makers(NamedTuple):
    """What is to be made, with what, where it goes, and where workers are, if they make it."""

    items: Sequence[Item]
    work: Work
    targets: Targets
    place: Place | None = None

    def written(self) -> Iterator[Written]:
        """Yield items in order, each when its files are written."""
        if self.place is None:
            yield from (_written(item, self.work, self.targets) for item in self.items)
            return
        tasks = self.tasks()
        ids = [[item.id for item in task] for task in tasks]
        given = (ids, self.work.settings(), self.targets)
        # All are under way at once: some take a thousand times as long as others.
        with Sharing(self.place, _Maker, given, ahead=len(tasks)) as workers:
            for task, came in zip(tasks, workers.over_tasks(len(tasks)), strict=True):
                for item, one in zip(task, came or [_DIED] * len(task), strict=True):
                    yield Written(Outcome(item, *one[:-1]), one.svg)

    def tasks(self) -> list[list[Item]]:
        """Return items that stand together and share a file, and what it measures."""
        made_by = groupby(self.items, lambda item: item.make.__module__)
        return [[*some] for _, some in made_by]


def _written(item: Item, work: Work, targets: Targets) -> Written:
    (outcome,) = outcomes((item,), work)
    svg = targets.write(outcome)
    if outcome.made is not None:  # a figure takes much memory
        outcome = replace(outcome, made=replace(outcome.made, figure=None))
    return Written(outcome, svg)


class _Came(NamedTuple):
    """What comes back from a worker: an outcome without its item, which can't be pickled."""

    made: Made | None
    error: str
    trace: str
    seconds: float
    svg: bytes | None


_DIED = _Came(None, KILLER, "", 0.0, None)


class _Maker:
    """Makes items in a worker."""

    def __init__(self, given: tuple[list[list[str]], tuple[int, int, bool, str], Targets]) -> None:
        from tactile_graph.compiled import warm_up
        from tactile_graph_thesis.catalogue import items

        ids, settings, self._targets = given
        by_id = {item.id: item for item in items()}
        self._tasks = [[by_id[name] for name in task] for task in ids]
        self._work = Work(*settings)
        warm_up()

    def __call__(self, portion: Portion) -> list[_Came] | None:
        """Return a task's items, written; None where workers die of it."""
        if portion.low in portion.without:
            return None
        found = []
        for item in self._tasks[portion.low]:
            o, svg = _written(item, self._work, self._targets)
            found.append(_Came(o.made, o.error, o.trace, o.seconds, svg))
        return found
