"""Study ``noise-algorithms``: every localiser under added known noise (section 6.1.3)."""

from __future__ import annotations

from typing import Any

from tactile_graph_pads.calibration.plot import new_figure
from tactile_graph_thesis.item import Item, Made, Table
from tactile_graph_thesis.items.noise_blocks import (
    CELLS,
    CIRCLE,
    NEW,
    RECTANGLE,
    chain_responses,
)
from tactile_graph_thesis.measure.noise import VOLTS
from tactile_graph_thesis.work import Work


def _algorithms(work: Work) -> Made:
    figure = new_figure(11.0, 6.8)
    grid = figure.subplots(2, 3, squeeze=False)
    rows: list[tuple[Any, ...]] = []
    for i, (chain, names) in enumerate(
        (
            (CIRCLE, ("circle-1", "circle-2", "circle-3")),
            (RECTANGLE, ("rectangle-1", "rectangle-2", "rectangle-3")),
        )
    ):
        places = {"frame": (VOLTS,), "footprint": CELLS}
        for name in names:
            found = chain_responses(work, chain._replace(pipeline=name, places=places))
            for j, noise in enumerate((VOLTS, *CELLS)):
                some = found["frame" if noise is VOLTS else "footprint", noise.name]
                for level, r in zip((0.0, *noise.levels), some, strict=True):
                    rows.append(
                        (
                            name,
                            noise.name,
                            noise.unit,
                            level,
                            *map(float, r.error),
                            100.0 * r.missing,
                        )
                    )
                grid[i][j].plot(
                    noise.levels, [r.error[1] for r in some[1:]], "o-", ms=4, label=name
                )
        for j, noise in enumerate((VOLTS, *CELLS)):
            axes, (quantity, unit) = grid[i][j], chain.quantities[1]
            axes.set(
                xscale="log",
                title=noise.name,
                ylabel=f"{quantity}: mean error / {unit}",
                xlabel=f"level / {noise.unit}" if noise is VOLTS else "share of the elements",
            )
            axes.set_ylim(bottom=0.0)
            axes.grid(alpha=0.3)
            axes.legend(fontsize="small")
    columns = (
        "pipeline",
        "noise",
        "unit",
        "level",
        "centre_cm or angle_degree",
        "radius_cm or length_cm",
        "lost_percent",
    )
    return Made(table=Table(columns, rows), figure=figure)


ITEMS = (
    Item(
        "noise-algorithms",
        "All localisers under added noise",
        "Error of the radius or the length against noise on the image, elements switched on and "
        "elements switched off, for each stage of the evolution.",
        _algorithms,
        NEW,
    ),
)
