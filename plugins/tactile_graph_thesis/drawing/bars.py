"""Bars: one number of several ways side by side, group by group."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from tactile_graph_pads.calibration.plot import new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def bars(groups: Mapping[str, Mapping[str, float]], axis: str, title: str) -> Figure:
    """Return a figure with a bar for each way in each group.

    Parameters
    ----------
    groups : mapping
        Group -> way -> number; every group has the same ways.
    axis, title : str
        What the bars are long in, with its unit, and what is to be seen.
    """
    ways = list(next(iter(groups.values())))
    figure = new_figure(7.5, 1.4 + 0.32 * len(groups) * (len(ways) + 1))
    axes = figure.subplots()
    thick = 0.8 / len(ways)
    for k, way in enumerate(ways):
        at = np.arange(len(groups)) + (k - 0.5 * (len(ways) - 1)) * thick
        drawn = axes.barh(at, [of[way] for of in groups.values()], 0.9 * thick, label=way)
        axes.bar_label(drawn, fmt="%.3g", padding=3, fontsize="small")
    axes.set_yticks(range(len(groups)), list(groups))
    axes.invert_yaxis()
    axes.margins(x=0.12)
    axes.set_xlabel(axis)
    axes.set_title(title)
    axes.grid(alpha=0.3, axis="x")
    figure.legend(loc="outside lower center", ncols=min(len(ways), 4), fontsize="small")
    return figure
