"""The divider whose row drivers have resistance: columns couple through the rows.

With Z the network's resistance matrix while no column is read, reading column j adds one
conductance to ground, so one solution of the network serves all elements (Sherman, Morrison):
``v_ij = G_driver Z_ij / (1 + G_ref Z_jj)``.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tactile_graph_pads.circuits.inverse import Inverse
from tactile_graph_pads.circuits.network import bipartite, transfer_resistances
from tactile_graph_pads.circuits.newton import solve_log

Array = NDArray[np.float64]


def driven_ratio(siemens: Array, driver_s: float, reference_s: float, gain: float) -> Array:
    """Return what each element measures as, in shares of the supply, shape (rows, columns).

    Parameters
    ----------
    siemens : ndarray of float64, shape (rows, columns)
    driver_s : float
        Conductance of each row's driver, idle ones too.
    reference_s : float
        Conductance from the read column to ground.
    gain : float
        Share of the column's voltage that is measured.
    """
    return _measured(transfer_resistances(bipartite(siemens, driver_s)), siemens.shape[0],
                     driver_s, reference_s, gain)  # fmt: skip


def _measured(z: Array, rows: int, driver_s: float, reference_s: float, gain: float) -> Array:
    column = np.diagonal(z)[rows:]
    # a column nothing conducts to is at an unknown voltage, but no row's voltage reaches it
    alone = ~np.isfinite(column)
    loaded = 1.0 + reference_s * np.where(alone, 0.0, column)
    return np.asarray(gain * driver_s * np.where(alone, 0.0, z[:rows, rows:]) / loaded)


def driven_inverse(
    ratio: Array,
    valid: NDArray[np.bool_],
    start: Array,
    driver_s: float,
    reference_s: float,
    gain: float,
) -> Inverse:
    """Return the conductances that measure as ``ratio``, by damped Newton.

    Parameters
    ----------
    ratio : ndarray of float64, shape (rows, columns)
        Measured shares of the supply; 0 or less stands for an element that does not conduct.
    valid : ndarray of bool, shape (rows, columns)
        Which columns are possible; the others are taken as not conducting.
    start : ndarray of float64, shape (rows, columns)
        Conductances to start from.
    driver_s, reference_s, gain : float
        As in `driven_ratio`.
    """
    rows, columns = ratio.shape
    on = valid & (ratio > 0.0)
    if not on.any():
        return Inverse(np.zeros(ratio.shape), valid)
    siemens = np.zeros(ratio.shape)

    def fill(log_siemens: Array) -> Array:
        siemens[on] = np.exp(log_siemens)
        return siemens

    def log_model(log_siemens: Array) -> Array:
        return np.log(driven_ratio(fill(log_siemens), driver_s, reference_s, gain)[on])

    def jacobian(log_siemens: Array) -> Array:
        z = transfer_resistances(bipartite(fill(log_siemens), driver_s))
        z = np.where(np.isfinite(z), z, 0.0)
        drop = z[:, :rows, None] - z[:, None, rows:]
        across, own = drop[:rows], drop[rows:]
        slope = (
            -across[:, None] * own[None, :] / np.where(on, z[:rows, rows:], 1.0)[:, :, None, None]
        )
        share = reference_s / (1.0 + reference_s * np.diagonal(z)[rows:])
        slope += (share[:, None, None] * own**2)[None]
        slope = slope.reshape(rows * columns, rows * columns)[np.ix_(on.ravel(), on.ravel())]
        return np.asarray(slope * siemens[on])

    first = np.log(np.where(start[on] > 0.0, start[on], ratio[on] * reference_s))
    found = solve_log(np.log(ratio[on]), log_model, jacobian, first)
    return Inverse(fill(found.log_siemens), valid, found.residual, found.iterations)
