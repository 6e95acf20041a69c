"""Section 6.1.3, study ``noise-algorithms``: every localiser under added known noise."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from tactile_graph_pads.calibration.plot import new_figure
from tactile_graph_thesis.item import Item, Made, Table
from tactile_graph_thesis.measure.noise_response import (
    CELLS,
    CIRCLE,
    NOT_IN_THE_THESIS,
    RECTANGLE,
    VOLTS,
    Chain,
    Responses,
    chain_responses,
)
from tactile_graph_thesis.work import Work

if TYPE_CHECKING:
    from matplotlib.axes import Axes

PIPELINES = (
    (CIRCLE, ("circle-1", "circle-2", "circle-3")),
    (RECTANGLE, ("rectangle-1", "rectangle-2", "rectangle-3", "ellipse-direct")),
)
"""What is read off, and the stages of an evolution it is read off."""
PLACES = {"frame": (VOLTS,), "footprint": CELLS}
COLUMNS = (
    "pipeline",
    "noise",
    "unit",
    "level",
    "centre_cm or angle_degree",
    "radius_cm or length_cm",
    "lost_percent",
)


def _algorithms(work: Work) -> Made:
    figure = new_figure(11.0, 6.8)
    rows: list[tuple[Any, ...]] = []
    for (chain, names), parts in zip(PIPELINES, figure.subplots(2, 3, squeeze=False), strict=True):
        for name in names:
            found = chain_responses(work, chain._replace(pipeline=name, places=PLACES))
            rows += _rows(name, found)
            _draw(parts, name, found)
        _finish(parts, chain)
    return Made(table=Table(COLUMNS, rows), figure=figure)


def _rows(name: str, found: Responses) -> list[tuple[Any, ...]]:
    return [
        (name, noise.name, noise.unit, level, *map(float, r.error), 100.0 * r.missing)
        for node, noises in PLACES.items()
        for noise in noises
        for level, r in zip((0.0, *noise.levels), found[node, noise.name], strict=True)
    ]


def _draw(parts: Sequence[Axes], name: str, found: Responses) -> None:
    noises = [(node, noise) for node, some in PLACES.items() for noise in some]
    for axes, (node, noise) in zip(parts, noises, strict=True):
        errors = [r.error[1] for r in found[node, noise.name][1:]]
        axes.plot(noise.levels, errors, "o-", ms=4, label=name)


def _finish(parts: Sequence[Axes], chain: Chain) -> None:
    quantity, unit = chain.quantities[1]
    for axes, noise in zip(parts, (VOLTS, *CELLS), strict=True):
        axes.set(
            xscale="log",
            title=noise.name,
            ylabel=f"{quantity}: mean error / {unit}",
            xlabel=f"level / {noise.unit}" if noise is VOLTS else "share of the elements",
        )
        axes.set_ylim(bottom=0.0)
        axes.grid(alpha=0.3)
        axes.legend(fontsize="small")


ITEMS = (
    Item(
        "noise-algorithms",
        "All localisers under added noise",
        "Error of the radius or the length against noise on the image, elements switched on and "
        "elements switched off, for each stage of the evolution.",
        _algorithms,
        NOT_IN_THE_THESIS,
        after="6.1.3",
    ),
)
