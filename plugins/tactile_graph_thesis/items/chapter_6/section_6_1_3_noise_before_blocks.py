"""Section 6.1.3, studies ``noise-circles`` and ``noise-rectangles``: noise before each block."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph_pads.calibration.plot import new_figure
from tactile_graph_thesis.item import Item, Made, Table
from tactile_graph_thesis.measure.noise_response import (
    CIRCLE,
    NOISES,
    NOT_IN_THE_THESIS,
    RECTANGLE,
    Chain,
    Responses,
    chain_responses,
)
from tactile_graph_thesis.work import Work

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Array = NDArray[np.float64]


def _blocks(chain: Chain) -> Callable[[Work], Made]:
    """Return a function that makes the study of a chain's blocks."""

    def make(work: Work) -> Made:
        found = chain_responses(work, chain)
        return Made(
            table=_table(chain, found), figure=_figure(chain, found), notes=_gains(chain, found)
        )

    return make


def _table(chain: Chain, found: Responses) -> Table:
    (one, one_unit), (two, two_unit) = chain.quantities
    columns = (
        "before",
        "noise",
        "unit",
        "level",
        f"{one} error_{one_unit}",
        f"{two} error_{two_unit}",
        f"{one} moved_{one_unit}",
        f"{two} moved_{two_unit}",
        "lost_percent",
    )
    rows = []
    for (node, name), some in found.items():
        noise = next(n for n in NOISES if n.name == name)
        for level, r in zip((0.0, *noise.levels), some, strict=True):
            rows.append(
                (
                    chain.blocks[node],
                    name,
                    noise.unit,
                    level,
                    *map(float, r.error),
                    *map(float, r.moved),
                    100.0 * r.missing,
                )
            )
    return Table(columns, rows)


def _figure(chain: Chain, found: Responses) -> Figure:
    used = [n for n in NOISES if any(name == n.name for _, name in found)]
    figure = new_figure(3.1 * len(used) + 0.8, 6.8)
    grid = figure.subplots(2, len(used), sharey="row", squeeze=False)
    nodes = list(chain.places)
    for j, noise in enumerate(used):
        for (node, name), some in found.items():
            if name != noise.name:
                continue
            k = nodes.index(node)
            for i in (0, 1):
                values = [r.error[i] for r in some[1:]]
                grid[i][j].plot(
                    noise.levels,
                    values,
                    "o-",
                    ms=3.5,
                    color=f"C{k}",
                    label=f"before {chain.blocks[node]}",
                )
        for i, (name, unit) in enumerate(chain.quantities):
            without = next(iter(found.values()))[0].error[i]
            grid[i][j].axhline(without, color="0.5", ls=":", label="without noise")
            grid[i][j].set_xscale("log")
            grid[i][j].grid(alpha=0.3)
            if j == 0:
                grid[i][j].set_ylabel(f"{name}: mean error / {unit}")
        grid[0][j].set_title(noise.name)
        grid[1][j].set_xlabel(f"level / {noise.unit}" if noise.unit != "share" else "share")
    handles: dict[str, Any] = {}
    for axes in grid.flat:
        handles |= dict(zip(*reversed(axes.get_legend_handles_labels()), strict=True))
    figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=4)
    return figure


def _gains(chain: Chain, found: Responses) -> tuple[str, ...]:
    """Return, in words, how much more or less noise does before a block than after it."""
    notes = []
    for noise in NOISES:
        nodes = [node for node, name in found if name == noise.name]
        k = len(noise.levels) // 2
        moved = {node: found[node, noise.name][k + 1].moved for node in nodes}
        words = [
            f"{chain.blocks[before]} {gain}"
            for before, after in pairwise(nodes)
            if (gain := _gain(chain, moved[before], moved[after]))
        ]
        if words:
            level = f"{noise.levels[k]:g}" + ("" if noise.unit == "share" else f" {noise.unit}")
            notes.append(
                f"{noise.name.capitalize()}, level {level}: what the answer moves by, "
                f"noise before the block over noise after it: {'; '.join(words)}."
            )
    return tuple(notes)


def _gain(chain: Chain, before: Array, after: Array) -> str:
    """Return the ratio of two movements for each quantity that moves at all."""
    named = zip(chain.quantities, before, after, strict=True)
    return ", ".join(f"{a / b:.2f} ({name})" for (name, _), a, b in named if b > 0.0)


_HOW = (
    " Noise of a known size is brought in between one block and the next by a step of its own; "
    "conditions of the pipeline still see the values without it."
)
ITEMS = (
    Item(
        "noise-circles",
        "Noise before each block of circle-3",
        "Which block lets noise through, which takes it away.",
        _blocks(CIRCLE),
        NOT_IN_THE_THESIS + _HOW,
        after="6.1.3",
    ),
    Item(
        "noise-rectangles",
        "Noise before each block of rectangle-1",
        "Which block lets noise through, which takes it away.",
        _blocks(RECTANGLE),
        NOT_IN_THE_THESIS + _HOW,
        after="6.1.3",
    ),
)
