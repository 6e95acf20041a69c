"""Numbers beside numbers: ours with its range, the thesis' as a diamond, a panel for each unit."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from tactile_graph_pads.calibration.plot import new_figure
from tactile_graph_thesis.drawing.panels import FOUND, TRUE
from tactile_graph_thesis.item import Compared

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def beside_figure(compared: Sequence[Compared], title: str, axis: str = "error") -> Figure:
    """Return a figure of numbers beside the thesis'.

    Parameters
    ----------
    compared : sequence of Compared
    title : str
    axis : str
        What the numbers are.
    """
    units = list(dict.fromkeys(c.unit for c in compared))
    rows = [[c for c in compared if c.unit == unit] for unit in units]
    figure = new_figure(7.5, 1.5 + 0.24 * len(compared) + 0.4 * len(units))
    parts = figure.subplots(
        len(units), 1, squeeze=False, gridspec_kw={"height_ratios": [len(r) for r in rows]}
    ).flat
    for axes, unit, some in zip(parts, units, rows, strict=True):
        _panel(axes, some, f"{axis} / {unit}")
    handles, labels = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3)
    figure.suptitle(title)
    return figure


def _panel(axes: Axes, some: Sequence[Compared], label: str) -> None:
    at = range(len(some))
    for k, one in zip(at, some, strict=True):
        if one.low is not None and one.high is not None:
            name = "nine in ten of ours" if k == 0 else None
            axes.plot([one.low, one.high], [k, k], color=FOUND, lw=4, alpha=0.3, label=name)
    axes.plot([c.ours for c in some], at, "o", color=FOUND, label="ours")
    known = [(c.thesis, k) for k, c in zip(at, some, strict=True) if c.thesis is not None]
    axes.plot(
        [x for x, _ in known], [k for _, k in known], "D", mfc="none", color=TRUE, label="thesis"
    )
    axes.set_yticks(list(at), [c.what for c in some], fontsize=8)
    axes.invert_yaxis()
    axes.set_xlim(left=0.0)
    axes.set_xlabel(label)
    axes.grid(alpha=0.3)
