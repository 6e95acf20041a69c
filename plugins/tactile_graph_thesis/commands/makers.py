"""``Makers``: who makes the items and writes their files, this process or workers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from tactile_graph_thesis.commands.targets import Targets
from tactile_graph_thesis.item import Item, Made
from tactile_graph_thesis.making import Outcome, outcomes
from tactile_graph_thesis.work import Work

if TYPE_CHECKING:
    from tactile_graph.many.executor_kind import Place
    from tactile_graph.many.portion import Portion


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
        from tactile_graph.many.sharing import KILLER, Sharing

        ids = [item.id for item in self.items]
        given = (ids, self.work.settings(), self.targets)
        # All are under way at once: some take a thousand times as long as others.
        with Sharing(self.place, _Maker, given, ahead=len(ids)) as workers:
            for item, came in zip(self.items, workers.over_tasks(len(ids)), strict=True):
                if came is None:
                    yield Written(Outcome(item, None, KILLER), None)
                else:
                    yield Written(Outcome(item, *came[:-1]), came.svg)


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


class _Maker:
    """Makes items in a worker."""

    def __init__(self, given: tuple[list[str], tuple[int, int, bool, str], Targets]) -> None:
        from tactile_graph.compiled import warm_up
        from tactile_graph_thesis.catalogue import items

        ids, settings, self._targets = given
        by_id = {item.id: item for item in items()}
        self._items = [by_id[name] for name in ids]
        self._work = Work(*settings)
        warm_up()

    def __call__(self, portion: Portion) -> _Came | None:
        """Return an item, written; None where workers die of it."""
        if portion.low in portion.without:
            return None
        (o, svg) = _written(self._items[portion.low], self._work, self._targets)
        return _Came(o.made, o.error, o.trace, o.seconds, svg)
