"""Table 4.9: five objects identified by weight and area."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from tactile_graph_pads.calibration.plot import new_figure
from tactile_graph_thesis.item import Compared, Finding, Item, Made, Table
from tactile_graph_thesis.measure.identification_errors import (
    THESIS_CLASSIFIER,
    Confusion,
    added,
    table_4_9,
)
from tactile_graph_thesis.numbers import numbers
from tactile_graph_thesis.work import Work

if TYPE_CHECKING:
    from matplotlib.figure import Figure


PADS = 3
"""Simulated pads over which readings are counted; one for a quick look."""
PRINTED = "minimum_distance"
"""Equation 4.8 as printed."""


def _table_4_9(work: Work) -> Made:
    said = numbers("table-4.9")
    n, n_pads = int(said["readings"]), 1 if work.quick else PADS
    seeds = range(work.seed, work.seed + n_pads)
    pads = [table_4_9(n, seed, work.pad_name) for seed in seeds]
    found = {name: added([pad[name] for pad in pads]) for name in pads[0]}
    ours = found[THESIS_CLASSIFIER]
    compared = tuple(
        Compared(
            f"{name}: readings identified",
            "%",
            100.0 * one.share_right,
            float(said["right_percent"]) if name == THESIS_CLASSIFIER else None,
        )
        for name, one in found.items()
    )
    rows = [
        (name, true, got, n)
        for name, one in found.items()
        for (true, got), n in sorted(one.nearest.items())
    ]
    return Made(
        compared,
        (all_identified(found), betters_the_printed(found)),
        Table(("classifier", "true", "identified as", "readings"), rows),
        _confusion_figure([found[PRINTED], found[THESIS_CLASSIFIER]]),
        notes=(
            f"Simulated pads: {n_pads}; {n} readings of each object to learn it and {n} to test it "
            f"on each; {n_pads * n * len(ours.names) - ours.n} of these leave no circle, and so no "
            "area, and are left out.",
        ),
    )


def all_identified(found: Mapping[str, Confusion]) -> Finding:
    """Return whether the thesis' classifier is always right.

    Parameters
    ----------
    found : mapping
        By the classifier's name.
    """
    ours = found[THESIS_CLASSIFIER]
    return Finding(
        "every reading of the five objects is identified",
        f"{100 * ours.share_right:.1f} % of {ours.n} by the modified distance",
        "a single reading taken for another object",
        ours.share_right == 1.0,
    )


def betters_the_printed(found: Mapping[str, Confusion]) -> Finding:
    """Return whether the modified distance errs less than the equation it was made from.

    Parameters
    ----------
    found : mapping
        By the classifier's name.
    """
    ours, printed = found[THESIS_CLASSIFIER], found[PRINTED]
    return Finding(
        "of the combinations tried the modified distance gives the best results",
        f"{100 * ours.share_right:.1f} % right, {100 * printed.share_right:.1f} % by equation 4.8 "
        "as printed",
        "equation 4.8 being right as often",
        ours.share_right > printed.share_right,
    )


_TITLES = ("equation 4.8", "as modified, equations 4.9 and 4.10")


def _confusion_figure(found: Sequence[Confusion]) -> Figure:
    figure = new_figure(11.5, 5.2)
    for axes, one, title in zip(figure.subplots(1, 2), found, _TITLES, strict=True):
        counts = [[one.nearest.get((true, got), 0) for got in one.names] for true in one.names]
        axes.imshow(counts, "Greys", vmin=0, vmax=2 * np.max(counts))
        at = range(len(one.names))
        for i in at:
            for j in at:
                axes.text(j, i, str(counts[i][j]), ha="center", va="center")
        axes.set_xticks(at, one.names, rotation=20)
        axes.set_yticks(at, one.names)
        axes.set(xlabel="identified as", ylabel="object on the pad", title=f"readings, {title}")
    return figure


ITEMS = (
    Item(
        "table-4.9",
        "Five objects identified",
        "Readings of each object of table 4.9, identified by weight and area.",
        _table_4_9,
        "The pentagon's size is not given; one is assumed. Weights come off the calibration curve "
        "alone and areas from the circle, as in thesis-identify.",
        after="4.37",
    ),
)
