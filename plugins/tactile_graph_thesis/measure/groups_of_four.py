"""Groups of four neighbouring elements read under rising weights (thesis section 2.4.2)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.wires import Rectangle
from tactile_graph_pads.calibration.points import Observation
from tactile_graph_pads.pad import Pad
from tactile_graph_thesis.measure.bench import Bench

Array = NDArray[np.float64]
LIGHT_G = np.arange(50.0, 701.0, 50.0)
HEAVY_G = np.arange(750.0, 3001.0, 250.0)
N_GROUPS = 9
STACK_CM = 0.15
"""How far from the middle a stack of weights stands, per axis (section 2.4.2)."""


class GroupReadings(NamedTuple):
    """Groups of four neighbouring elements under rising weights.

    Parameters
    ----------
    weight_g : ndarray, shape (w,)
        On a whole group.
    corner : ndarray of int, shape (n, 2)
        Row and column of each group's top left element.
    volts, siemens : ndarray, shape (n, w, 4)
        What the four elements read, and the conductances found behind the whole frame.
    load_g : ndarray, shape (n, w, 4)
        What each of them truly bore.
    """

    weight_g: Array
    corner: NDArray[np.intp]
    volts: Array
    siemens: Array
    load_g: Array

    @property
    def group_v(self) -> Array:
        """Mean of the four, shape (n, w)."""
        return np.asarray(self.volts.mean(axis=2))

    def observations(self, quantity: str = "volt") -> list[Observation]:
        """Return what a calibration takes: one observation for each group and weight.

        Parameters
        ----------
        quantity : "volt" or "siemens"
        """
        values = self.volts if quantity == "volt" else self.siemens
        return [
            Observation(float(self.weight_g[w]) / 4.0, values[k, w], f"group {k + 1}")
            for w in range(len(self.weight_g))
            for k in range(len(self.corner))
        ]


def group_readings(
    pad: Pad,
    rng: np.random.Generator,
    weight_g: Array | None = None,
    n_groups: int = N_GROUPS,
) -> GroupReadings:
    """Return what groups of four elements read under rising weights, at random places.

    Parameters
    ----------
    pad : Pad
    rng : numpy.random.Generator
    weight_g : ndarray, shape (w,), optional
        On a whole group; figure 2.15's two ranges if not given.
    n_groups : int

    Notes
    -----
    A square plate covers exactly the four. It stays where it is while weights are stacked on
    it, each a little off the middle, so one group's curve keeps its unevenness.
    """
    weights = np.concatenate([LIGHT_G, HEAVY_G]) if weight_g is None else weight_g
    bench = Bench(pad, rng)
    rows, columns = pad.geometry.shape
    corner = np.stack(
        [rng.integers(0, rows - 1, n_groups), rng.integers(0, columns - 1, n_groups)], axis=1
    )
    volts, siemens, load = (np.empty((n_groups, len(weights), 4)) for _ in range(3))
    for k, (row, column) in enumerate(corner):
        four = (slice(row, row + 2), slice(column, column + 2))
        plate, gains = _plate(pad, row, column), _touching(bench, four)
        for w, grams in enumerate(weights):
            x, y = rng.normal(0.0, STACK_CM, 2)
            bears = bench.load_g(plate, float(grams), gains, (float(x), float(y)))
            read = bench.volts(bears)
            volts[k, w], load[k, w] = read[four].ravel(), bears[four].ravel()
            siemens[k, w] = bench.siemens(read)[0][four].ravel()
    return GroupReadings(weights, corner, volts, siemens, load)


def _plate(pad: Pad, row: int, column: int) -> Rectangle:
    geometry = pad.geometry
    side = 2.0 * geometry.element_cm + geometry.gap_cm
    x = 0.5 * (geometry.x_cm[column] + geometry.x_cm[column + 1])
    y = 0.5 * (geometry.y_cm[row] + geometry.y_cm[row + 1])
    return Rectangle(float(x), float(y), side, side, 0.0)


def _touching(bench: Bench, four: tuple[slice, slice]) -> Array:
    """Return gains for a plate that rests on at least one of its elements."""
    while True:
        gains = bench.gains()
        if gains[four].any():
            return gains
