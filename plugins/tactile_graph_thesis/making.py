"""Make items one after the other; one that fails is kept as a failure and stops none."""

from __future__ import annotations

import time
import traceback
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from tactile_graph.errors import TactileGraphError
from tactile_graph_thesis.item import Item, Made
from tactile_graph_thesis.work import Work


@dataclass(frozen=True, eq=False)
class Outcome:
    """What became of one item.

    Parameters
    ----------
    item : Item
    made : Made, optional
        None where it failed.
    error : str
        Why, in a line.
    trace : str
        The traceback of a failure.
    seconds : float
    """

    item: Item
    made: Made | None
    error: str = ""
    trace: str = ""
    seconds: float = 0.0


def outcomes(items: Sequence[Item], work: Work) -> Iterator[Outcome]:
    """Yield the outcome of each item.

    Parameters
    ----------
    items : sequence of Item
    work : Work
    """
    for item in items:
        start = time.perf_counter()
        made, error, trace = None, "", ""
        try:
            made = item.make(work)
        except Exception as caught:  # any item may fail, and the others are still wanted
            error = str(caught) or type(caught).__name__
            if not isinstance(caught, TactileGraphError):
                error = f"{type(caught).__name__}: {error}"
            trace = traceback.format_exc()
        yield Outcome(item, made, error, trace, time.perf_counter() - start)
