"""Section 4.3.4: the orientation of rectangles whose image is broken between its ends."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph import Mask
from tactile_graph.errors import Degenerate
from tactile_graph_fitters.orientation.orientation import orientation
from tactile_graph_pads.calibration.plot import new_figure
from tactile_graph_thesis.item import Finding, Item, Made, Table
from tactile_graph_thesis.work import Work

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Array = NDArray[np.float64]
PITCH_CM, CELLS = 1.3, 16
SIDES_CM = {"RECTANGLE I": (16.0, 7.0), "RECTANGLE II": (14.0, 3.0)}
LOST = (0.0, 0.2, 0.4, 0.6, 0.8)
"""Share of the length that is missing, from its middle out."""
TURNS = 36
KINDS = ("broken in the middle", "broken, one end lost too")
ACROSS_DEGREE = 45.0


class Broken(NamedTuple):
    """Errors of the axis of broken rectangles.

    Parameters
    ----------
    names : tuple of str
        Of the rectangles.
    error_degree : ndarray, shape (rectangles, kinds, lost, turns)
        Between the axis found and the true one, 0 to 90; NaN where nothing was left to turn.
    """

    names: tuple[str, ...]
    error_degree: Array

    @property
    def across(self) -> Array:
        """Share of images whose axis is nearer to the right angle, (rectangles, kinds, lost)."""
        there = np.isfinite(self.error_degree).sum(axis=-1)
        across = (self.error_degree > ACROSS_DEGREE).sum(axis=-1)
        return np.asarray(across / np.maximum(there, 1))


def broken() -> Broken:
    """Return the axis' errors of both rectangles in many turns, with a part of the length lost."""
    error = np.full((len(SIDES_CM), len(KINDS), len(LOST), TURNS), np.nan)
    for i, sides in enumerate(SIDES_CM.values()):
        for k, lost in enumerate(LOST):
            for t in range(TURNS):
                angle = np.pi * t / TURNS
                for kind in range(len(KINDS)):
                    mask = _image(sides, angle, lost, one_end=kind == 1)
                    error[i, kind, k, t] = _off(mask, angle)
    return Broken(tuple(SIDES_CM), error)


def _image(sides: tuple[float, float], angle: float, lost: float, one_end: bool) -> Mask:
    """Return which cells a rectangle in the middle covers, without the part that is lost."""
    middle = 0.5 * CELLS * PITCH_CM
    y, x = (np.indices((CELLS, CELLS)) + 0.5) * PITCH_CM - middle
    along = x * np.cos(angle) - y * np.sin(angle)  # y runs down, angles go up
    across = x * np.sin(angle) + y * np.cos(angle)
    on = (abs(along) <= sides[0] / 2) & (abs(across) <= sides[1] / 2)
    if lost:
        on &= abs(along) > lost * sides[0] / 2
        on &= (along > 0.0) | (not one_end)
    return Mask(on, (PITCH_CM, PITCH_CM))


def _off(mask: Mask, angle: float) -> float:
    try:
        found = orientation(mask).angle_rad
    except Degenerate:
        return float("nan")
    off = np.degrees(found - angle) % 180.0
    return float(min(off, 180.0 - off))


def _study(work: Work) -> Made:
    found = work.once("broken-image", broken)
    rows = [
        (
            name,
            kind,
            lost,
            float(np.nanmedian(found.error_degree[i, j, k])),
            float(found.across[i, j, k]),
        )
        for i, name in enumerate(found.names)
        for j, kind in enumerate(KINDS)
        for k, lost in enumerate(LOST)
    ]
    columns = ("object", "image", "lost_share", "median_error_degree", "share_across")
    return Made(findings=(gives_across(found),), table=Table(columns, rows), figure=_figure(found))


def gives_across(found: Broken) -> Finding:
    """Return whether an axis comes out across where both ends of an image are left.

    Parameters
    ----------
    found : Broken
    """
    both, one = (100 * float(found.across[:, kind, 1:].max()) for kind in (0, 1))
    return Finding(
        "an image broken between its ends gives an axis across the right one",
        f"with both ends left in {both:.0f} % of the turns at worst: ends that are far apart make "
        f"the axis surer; with one end lost too, in up to {one:.0f} %",
        "fewer than half of the turns across, whatever is lost between both ends",
        both >= 50.0,
    )


def _figure(found: Broken) -> Figure:
    figure = new_figure(6.4, 4.0)
    axes = figure.subplots()
    for i, name in enumerate(found.names):
        for j, kind in enumerate(KINDS):
            # The first lie below the second, wider: where two are equal both are seen.
            axes.plot(
                LOST, 100 * found.across[i, j], "o--" if j else "o-", color=f"C{i}",
                lw=4.0 - 2.5 * i, ms=9.0 - 3.5 * i, label=f"{name}, {kind}",
            )  # fmt: skip
    axes.set(
        xlabel="share of the length that is missing",
        ylabel="axes across the right one / %",
        title="Orientation of a broken image",
    )
    axes.grid(alpha=0.3)
    figure.legend(loc="outside lower center", ncols=2, fontsize="small")
    return figure


ITEMS = (
    Item(
        "broken-image",
        "Orientation of a broken image",
        "How often the axis lies across the object's when the middle of its image is missing, and "
        "when one of the two ends is missing as well.",
        _study,
        "The axis is that of the greatest variance, to which both ends of a broken image add; only "
        "what is left of one end alone can be broader than it is long.",
        after="4.3.4",
    ),
)
