"""Section 2.3.2: which elements a loaded one takes from: its column, its row, or others."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph_pads.calibration.plot import new_figure
from tactile_graph_pads.pad import Pad
from tactile_graph_thesis.item import Finding, Item, Made, Table
from tactile_graph_thesis.work import Work

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Array = NDArray[np.float64]
RESTING_G, ADDED_G = 20.0, 200.0
LITTLE = 0.01
"""Share of what a column takes that counts as little."""
PLACES = ("in the same column", "in the same row", "in an adjacent column", "elsewhere")


class Taken(NamedTuple):
    """What a load on one element takes from the readings of all others.

    Parameters
    ----------
    row, column : int
        The element.
    loss_v : ndarray, shape (rows, columns)
        Volts less than before; 0 at the element itself.
    """

    row: int
    column: int
    loss_v: Array

    @property
    def largest_v(self) -> dict[str, float]:
        """The largest change among each of `PLACES`."""
        rows, columns = np.indices(self.loss_v.shape)
        here, there = rows == self.row, columns == self.column
        beside = abs(columns - self.column) == 1
        parts = (
            there & ~here,
            here & ~there,
            beside & ~here,
            ~here & ~there & ~beside,
        )
        found = (float(abs(self.loss_v[part]).max()) for part in parts)
        return dict(zip(PLACES, found, strict=True))


def taken(pad: Pad) -> Taken:
    """Return what 200 g on the middle element take from all others, each of which bears 20 g.

    Parameters
    ----------
    pad : Pad
    """
    row, column = (n // 2 for n in pad.geometry.shape)
    load_g = np.full(pad.geometry.shape, RESTING_G)
    before = pad.forward(load_g)
    load_g[row, column] += ADDED_G
    loss = before - pad.forward(load_g)
    loss[row, column] = 0.0
    return Taken(row, column, loss)


def _directions(work: Work) -> Made:
    found = taken(work.pad)
    rows = [(place, 1e3 * volts) for place, volts in found.largest_v.items()]
    return Made(
        findings=(couples_in_columns(found),),
        table=Table(("place", "largest_change_mV"), rows),
        figure=_figure(found),
    )


def couples_in_columns(found: Taken) -> Finding:
    """Return whether a load takes from its column, and little from anything else.

    Parameters
    ----------
    found : Taken
    """
    largest = found.largest_v
    column = largest.pop("in the same column")
    words = ", ".join(f"{1e3 * volts:.2f} mV {place}" for place, volts in largest.items())
    return Finding(
        "elements of a column couple, those of a row or of adjacent columns little or not",
        f"{ADDED_G:.0f} g on an element take up to {1e3 * column:.0f} mV from its column, {words}",
        f"a change elsewhere of {100 * LITTLE:.0f} % of that in the column, or none there",
        column > 0.0 and max(largest.values()) < LITTLE * column,
    )


def _figure(found: Taken) -> Figure:
    figure = new_figure(5.2, 4.4)
    axes = figure.subplots()
    drawn = axes.imshow(1e3 * found.loss_v, "Greys", vmin=0.0)
    axes.plot(found.column, found.row, "x", color="#d81b60", label="the element that is loaded")
    axes.set(xlabel="column", ylabel="row", title=f"What {ADDED_G:.0f} g on one element take")
    axes.legend(loc="upper right", fontsize="small")
    figure.colorbar(drawn, label="volts less / mV")
    return figure


ITEMS = (
    Item(
        "coupling-directions",
        "Where coupling goes",
        "How much less every other element reads when one is loaded more heavily.",
        _directions,
        "Nothing is random here: the circuit of the pad is solved for two loads.",
        after="2.3.2",
    ),
)
