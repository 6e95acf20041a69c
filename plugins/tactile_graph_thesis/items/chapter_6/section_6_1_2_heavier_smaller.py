"""Section 6.1.2: heavier objects of smaller areas, beside the curves of section 2.4.3."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from tactile_graph_pads.calibration.plot import new_figure
from tactile_graph_pads.pad import Pad
from tactile_graph_thesis.item import Finding, Item, Made, Table
from tactile_graph_thesis.items.chapter_2.figure_2_19_weight_against_area import (
    curves,
    put_down,
    table_2_2_radii_cm,
    weighed_g,
)
from tactile_graph_thesis.measure.bench import ON_ONE_PAD, Bench
from tactile_graph_thesis.work import Work

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Array = NDArray[np.float64]
WEIGHTS_G = (1000.0, 2000.0, 3000.0)
"""The same on every area, where section 2.4.3 has the same on every element. Heavier ones leave the
calibration on the smallest disc."""
PLACEMENTS, QUICK_PLACEMENTS = 24, 8


def _heavier_smaller(work: Work) -> Made:
    n = QUICK_PLACEMENTS if work.quick else PLACEMENTS
    radius = np.array(sorted(table_2_2_radii_cm().values()))
    lost = _lost_percent(work.pad, np.random.default_rng(work.seed), radius, n)
    area = np.pi * radius**2
    rows = [
        (float(r), float(a), w, w / float(a), float(lost[k, j]))
        for k, (r, a) in enumerate(zip(radius, area, strict=True))
        for j, w in enumerate(WEIGHTS_G)
    ]
    columns = ("radius_cm", "area_cm2", "weight_g", "g_per_cm2", "weight lost_%")
    return Made(
        findings=(smaller_is_better(lost), area_counts_more(lost)),
        table=Table(columns, rows),
        figure=_figure(area, lost),
    )


def _lost_percent(pad: Pad, rng: np.random.Generator, radius_cm: Array, n: int) -> Array:
    """Return what is missing of the weights in the mean of n placements, shape (radii, weights)."""
    volt = curves(pad, rng)[0]
    bench = Bench(pad, rng)
    found = np.array([
        [np.mean([weighed_g(volt, put_down(bench, float(r), w)) for _ in range(n)])
         for w in WEIGHTS_G]
        for r in radius_cm
    ])  # fmt: skip
    return np.asarray(100.0 * (1.0 - found / np.array(WEIGHTS_G)))


def smaller_is_better(lost: Array) -> Finding:
    """Return whether of the same weight less is lost on the smallest area than on the largest.

    Parameters
    ----------
    lost : ndarray, shape (radii, weights)
        In percent, radii rising.
    """
    words = ", ".join(
        f"{small:.0f} and {large:.0f} % of {w / 1000:g} kg"
        for w, small, large in zip(WEIGHTS_G, lost[0], lost[-1], strict=True)
    )
    return Finding(
        "smaller areas are recorded more faithfully than larger ones, at the same weight too",
        f"lost on the smallest and on the largest: {words}",
        "a weight of which the smallest loses as much as the largest",
        bool((np.abs(lost[0]) < np.abs(lost[-1])).all()),
    )


def area_counts_more(lost: Array) -> Finding:
    """Return whether the area makes more of a difference than the weight does.

    Parameters
    ----------
    lost : ndarray, shape (radii, weights)
        In percent, radii rising.
    """
    by_area = float(np.mean(np.abs(lost[-1] - lost[0])))
    by_weight = float(np.mean(np.abs(lost[:, -1] - lost[:, 0])))
    return Finding(
        "(not in the thesis) the area decides, and not the weight on each element",
        f"from the smallest area to the largest {by_area:.0f} points of the weight, from "
        f"{WEIGHTS_G[0] / 1000:g} to {WEIGHTS_G[-1] / 1000:g} kg {by_weight:.0f}",
        "a weight that makes half as much of a difference as the area, or more",
        by_weight < 0.5 * by_area,
    )


def _figure(area_cm2: Array, lost: Array) -> Figure:
    figure = new_figure(6.4, 4.6)
    axes = figure.subplots()
    for j, weight in enumerate(WEIGHTS_G):
        axes.plot(area_cm2, lost[:, j], "o-", ms=4, label=f"{weight / 1000:g} kg")
    axes.axhline(0.0, color="0.5", lw=0.8)
    axes.set(xlabel="area / cm²", ylabel="weight lost / %", title="The same weight on each area")
    axes.grid(alpha=0.3)
    axes.legend()
    return figure


ITEMS = (
    Item(
        "heavier-smaller",
        "Heavier and smaller",
        "What the calibration curve misses of the same weight on each disc of table 2.2, so that "
        "smaller ones press the harder.",
        _heavier_smaller,
        ON_ONE_PAD + " The thesis wishes for this comparison and has not made it.",
        after="6.1.2",
    ),
)
