"""One element of a column, alone and with loaded neighbours: the circuit of figures 2.8 to 2.11."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tactile_graph_pads.circuits.divider import Divider

Array = NDArray[np.float64]


def element_volts(
    resistance_ohm: ArrayLike,
    bias_ohm: ArrayLike = 33e3,
    neighbours_ohm: ArrayLike = (),
    supply_v: float = 5.0,
) -> Array:
    """Return the volts of one element of a column, shape (n_bias, n_resistance).

    Parameters
    ----------
    resistance_ohm : array_like, shape (n_resistance,)
        What the element is varied over.
    bias_ohm : array_like, shape (n_bias,)
        Bias resistors to try.
    neighbours_ohm : array_like, shape (n_neighbours,)
        The loaded others of its column; none for figure 2.8, eight of 80 kOhm for figure 2.9.
    supply_v : float
        What drives the row.
    """
    resistance, bias = np.atleast_1d(resistance_ohm), np.atleast_1d(bias_ohm)
    neighbours = np.atleast_1d(np.asarray(neighbours_ohm, dtype=np.float64))
    volts = np.empty((bias.size, resistance.size))
    columns = np.empty((1 + neighbours.size, resistance.size))
    columns[0] = 1.0 / resistance
    columns[1:] = 1.0 / neighbours[:, None]
    for row, ohm in enumerate(bias):
        circuit = Divider(bias_ohm=float(ohm), supply_v=supply_v)
        volts[row] = supply_v * circuit.ratio(columns)[0]
    return volts


def coupling_volts(
    resistance_ohm: ArrayLike,
    bias_ohm: ArrayLike = 33e3,
    neighbours_ohm: ArrayLike = (80e3,) * 8,
    supply_v: float = 5.0,
) -> Array:
    """Return how many volts the neighbours take from an element, shape (n_bias, n_resistance).

    The gap between the paired curves of figure 2.10; arguments as in `element_volts`.

    Parameters
    ----------
    resistance_ohm, bias_ohm, neighbours_ohm : array_like
        As in `element_volts`.
    supply_v : float
        What drives the row.
    """
    alone = element_volts(resistance_ohm, bias_ohm, (), supply_v)
    return alone - element_volts(resistance_ohm, bias_ohm, neighbours_ohm, supply_v)


def random_neighbours(
    rng: np.random.Generator,
    n_neighbours: int = 8,
    low_ohm: float = 60e3,
    high_ohm: float = 300e3,
) -> Array:
    """Return resistances of loaded neighbours as in figure 2.11, shape (n_neighbours,).

    Parameters
    ----------
    rng : numpy.random.Generator
    n_neighbours : int
        How many elements of the column are loaded.
    low_ohm, high_ohm : float
        The loads are spread evenly between these.
    """
    return rng.uniform(low_ohm, high_ohm, n_neighbours)
