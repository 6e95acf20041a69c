"""Section 5.3.2: what patterns of lines cost: lone elements, straight lines, closed ones."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph import Image
from tactile_graph_mrf.energy.line_field import no_lines
from tactile_graph_mrf.energy.model import Model
from tactile_graph_mrf.energy.problem import prepare
from tactile_graph_mrf.energy.total import energy
from tactile_graph_pads.calibration.plot import new_figure
from tactile_graph_thesis.item import Finding, Item, Made, Table
from tactile_graph_thesis.work import Work

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Bools = NDArray[np.bool_]
SIDE = 24
COUNTS = (4, 8, 12, 16)
"""How many line elements a pattern has; each can close a rectangle."""
PATTERNS = ("lone", "straight", "closed")


class PatternCosts(NamedTuple):
    """What a line element costs in a pattern.

    Parameters
    ----------
    counts : tuple of int
        Elements of a pattern.
    each : mapping
        One of `PATTERNS` -> energy over number of elements for each count, in units of lambda_l.
    """

    counts: tuple[int, ...]
    each: dict[str, tuple[float, ...]]


def pattern_costs() -> PatternCosts:
    """Return what an element costs alone, in a straight line and in a closed rectangle."""
    flat = Image(np.zeros((SIDE, SIDE)), quantity="level")
    model = Model(lines="explicit", lambda_l=1.0)
    problem = prepare(model, flat)
    labels = np.zeros((SIDE, SIDE), np.int64)
    each: dict[str, tuple[float, ...]] = {}
    for pattern in PATTERNS:
        costs = []
        for n in COUNTS:
            across, down = no_lines((SIDE, SIDE))
            _draw(pattern, n, across, down)
            assert int(across.sum() + down.sum()) == n
            costs.append(energy(problem, labels, across, down) / n)
        each[pattern] = tuple(costs)
    return PatternCosts(COUNTS, each)


def _draw(pattern: str, n: int, across: Bools, down: Bools) -> None:
    """Switch n elements on: far from each other, one after the other, or round a rectangle."""
    if pattern == "lone":
        for k in range(n):
            across[3 + 5 * (k // 4), 3 + 5 * (k % 4)] = True
    elif pattern == "straight":
        across[SIDE // 2, 3 : 3 + n] = True
    else:
        high = n // 4
        wide = n // 2 - high
        across[3, 4 : 4 + wide] = across[3 + high, 4 : 4 + wide] = True
        down[4 : 4 + high, 3] = down[4 : 4 + high, 3 + wide] = True


def _patterns(work: Work) -> Made:
    found = work.once("line-patterns", pattern_costs)
    rows = [
        (n, *(found.each[pattern][k] for pattern in PATTERNS)) for k, n in enumerate(found.counts)
    ]
    return Made(
        findings=(lone_cost_more(found),),
        table=Table(("elements", *(f"{p}_each" for p in PATTERNS)), rows),
        figure=_figure(found),
    )


def lone_cost_more(found: PatternCosts) -> Finding:
    """Return whether lone elements cost more than those that continue each other.

    Parameters
    ----------
    found : PatternCosts
    """
    lone, straight, closed = (found.each[pattern] for pattern in PATTERNS)
    falls = all(b < a for a, b in pairwise(straight))
    return Finding(
        "a lone line element costs more than one that continues others smoothly",
        f"of {found.counts[-1]} elements each costs {lone[-1]:.1f} alone, {straight[-1]:.1f} in a "
        f"straight line, {closed[-1]:.1f} round a rectangle (in units of lambda_l)",
        "an element that costs as much in a line, or one that costs no less the longer the line",
        falls and all(max(s, c) < one for one, s, c in zip(lone, straight, closed, strict=True)),
    )


def _figure(found: PatternCosts) -> Figure:
    figure = new_figure(5.6, 3.8)
    axes = figure.subplots()
    for pattern in PATTERNS:
        axes.plot(found.counts, found.each[pattern], "o-", label=pattern)
    axes.set(
        xlabel="line elements of the pattern",
        ylabel="energy of each / lambda_l",
        title="What patterns of lines cost",
    )
    axes.set_ylim(bottom=0.0)
    axes.grid(alpha=0.3)
    axes.legend()
    return figure


ITEMS = (
    Item(
        "line-patterns",
        "What patterns of lines cost",
        "The energy of a line element alone, in a straight line, and round a rectangle.",
        _patterns,
        "The numbers of figure 5.7 are lost; these are by the potentials that are ascribed to its "
        "source.",
        after="5.3.2",
    ),
)
