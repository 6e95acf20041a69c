"""What the book comes to: every table in a row, and the conclusions that do not come out."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from tactile_graph_thesis.item import Compared, Finding
from tactile_graph_thesis.making import Outcome

NEAR_PERCENT = (10, 30, 50)
"""How far off a number may be that is counted."""


class Nearness(NamedTuple):
    """How many numbers come near to the thesis'.

    Parameters
    ----------
    numbers : int
        How many there are.
    near : tuple of int
        How many of ours are at most so many percent (`NEAR_PERCENT`) off the thesis'.
    """

    numbers: int
    near: tuple[int, ...]

    def __str__(self) -> str:
        return f"{', '.join(map(str, self.near))} of {self.numbers}" if self.numbers else "–"


def nearness(rows: Sequence[Compared]) -> Nearness:
    """Return how many numbers come near to the thesis'.

    Parameters
    ----------
    rows : sequence of Compared
        Those without a ratio are left out.
    """
    off = [abs(c.ratio - 1.0) for c in rows if c.ratio is not None]
    near = (sum(o <= percent / 100.0 + 1e-12 for o in off) for percent in NEAR_PERCENT)
    return Nearness(len(off), tuple(near))


class TableLine(NamedTuple):
    """One table beside the thesis' in a line.

    Parameters
    ----------
    id, name, title : str
    averages, maxima : Nearness
        Of the thesis' numbers that are no maxima, and of those that are.
    within : int
        How many of the thesis' lie in our range.
    with_range : int
        How many of ours have a range.
    """

    id: str
    name: str
    title: str
    averages: Nearness
    maxima: Nearness
    within: int
    with_range: int


def table_lines(found: Sequence[Outcome]) -> list[TableLine]:
    """Return a line for every item with numbers of the thesis that are no mere limits.

    Parameters
    ----------
    found : sequence of Outcome
    """
    lines = []
    for o in found:
        rows = [c for c in (o.made.compared if o.made else ()) if c.ratio and not c.limit]
        if rows:
            ranged = [c.within for c in rows if c.within is not None]
            lines.append(
                TableLine(
                    o.item.id,
                    o.item.name,
                    o.item.title,
                    nearness([c for c in rows if not c.largest]),
                    nearness([c for c in rows if c.largest]),
                    sum(ranged),
                    len(ranged),
                )
            )
    return lines


def all_told(lines: Sequence[TableLine]) -> tuple[Nearness, Nearness]:
    """Return the averages and the maxima of all tables and figures together.

    Parameters
    ----------
    lines : sequence of TableLine
        Those of studies are left out: what they make again stands in a table already.
    """
    lines = [x for x in lines if x.id.startswith(("table-", "figure-"))]

    def told(parts: list[Nearness]) -> Nearness:
        near = (sum(p.near[k] for p in parts) for k in range(len(NEAR_PERCENT)))
        return Nearness(sum(p.numbers for p in parts), tuple(near))

    return told([x.averages for x in lines]), told([x.maxima for x in lines])


OURS_ALONE = "(not in the thesis)"
"""How the text of a finding begins that the thesis does not have."""


def conclusions(found: Sequence[Outcome]) -> list[tuple[Outcome, Finding]]:
    """Return every conclusion of the thesis with the item it belongs to.

    Parameters
    ----------
    found : sequence of Outcome
    """
    return [
        (o, f)
        for o in found
        if o.made
        for f in o.made.findings
        if not f.thesis.startswith(OURS_ALONE)
    ]
