"""What the book comes to: every table in a row, and the conclusions that do not come out."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from tactile_graph_thesis.item import Compared, Finding
from tactile_graph_thesis.making import Outcome


class TableLine(NamedTuple):
    """One table beside the thesis' in a line.

    Parameters
    ----------
    id, name, title : str
    numbers : int
        How many the thesis gives.
    median_ratio : float
        Of ours to the thesis'.
    within : int
        How many of the thesis' lie in our range.
    with_range : int
        How many of ours have a range.
    """

    id: str
    name: str
    title: str
    numbers: int
    median_ratio: float
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
                    len(rows),
                    _median_ratio(rows),
                    sum(ranged),
                    len(ranged),
                )
            )
    return lines


def _median_ratio(rows: Sequence[Compared]) -> float:
    """Return the median of ratios: of two middle ones the geometric mean."""
    ratios = sorted(c.ratio for c in rows if c.ratio is not None)
    middle = len(ratios) // 2
    return ratios[middle] if len(ratios) % 2 else math.sqrt(ratios[middle - 1] * ratios[middle])


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
