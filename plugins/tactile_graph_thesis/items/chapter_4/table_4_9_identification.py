"""Table 4.9: five objects identified by weight and area."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tactile_graph_pads.calibration.plot import new_figure
from tactile_graph_thesis.item import Compared, Finding, Item, Made, Table
from tactile_graph_thesis.measure.identification_errors import (
    THESIS_CLASSIFIER,
    Confusion,
    table_4_9,
)
from tactile_graph_thesis.numbers import numbers
from tactile_graph_thesis.work import Work

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def _table_4_9(work: Work) -> Made:
    said = numbers("table-4.9")
    found = table_4_9(int(said["readings"]), work.seed, work.pad_name)
    compared = tuple(
        Compared(
            f"{name}: readings identified",
            "%",
            100.0 * one.share_right,
            float(said["right_percent"]),
        )
        for name, one in found.items()
    )
    ours = found[THESIS_CLASSIFIER]
    rows = [
        (name, true, got, n)
        for name, one in found.items()
        for (true, got), n in sorted(one.nearest.items())
    ]
    return Made(
        compared,
        (
            Finding(
                "every reading of the five objects is identified",
                f"{100 * ours.share_right:.1f} % of {ours.n} by the thesis' classifier",
                ours.share_right == 1.0,
            ),
        ),
        Table(("classifier", "true", "identified as", "readings"), rows),
        _confusion_figure(ours),
    )


def _confusion_figure(found: Confusion) -> Figure:
    counts = [[found.nearest.get((true, got), 0) for got in found.names] for true in found.names]
    figure = new_figure(6.4, 5.0)
    axes = figure.subplots()
    axes.imshow(counts, "Greys", vmin=0, vmax=2 * np.max(counts))
    at = range(len(found.names))
    for i in at:
        for j in at:
            axes.text(j, i, str(counts[i][j]), ha="center", va="center")
    axes.set_xticks(at, found.names, rotation=20)
    axes.set_yticks(at, found.names)
    axes.set(
        xlabel="identified as",
        ylabel="object on the pad",
        title="readings, classifier of equations 4.9 and 4.10",
    )
    return figure


ITEMS = (
    Item(
        "table-4.9",
        "Five objects identified",
        "Readings of each object of table 4.9, identified by weight and area.",
        _table_4_9,
        "The pentagon's size is not given; one is assumed.",
        after="4.37",
    ),
)
