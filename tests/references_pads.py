"""What kernels of tactile_graph_pads are held against: the same answers, vectorised."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tactile_graph_pads.law import LEAST_ROOM

Array = NDArray[np.float64]


def conductance_kernel(load_g: Array, law: Array) -> Array:
    """Return the conductance in siemens of each element under ``load_g``; ``law`` as packed."""
    p, log_c, log_on, bend, log_sat, headroom = law
    out = np.zeros(load_g.shape)
    on = load_g > 0.0
    log_load = np.log(load_g[on])
    below = np.minimum(log_load - log_on, 0.0)
    over = np.maximum(log_load - log_sat, 0.0)
    power = np.exp(log_c + p * (log_load - over) - bend * below**2)
    out[on] = power * (1.0 - headroom * np.expm1(-p / headroom * over))
    return out


def load_kernel(siemens: Array, law: Array) -> Array:
    """Return the force in grams behind each conductance; inf where no force can reach it."""
    p, log_c, log_on, bend, log_sat, headroom = law
    out = np.zeros(siemens.shape)
    on = siemens > 0.0
    y = np.log(siemens[on]) - log_c
    with np.errstate(over="ignore"):  # no force reaches such conductances: inf
        excess = np.exp(np.maximum(y - p * log_sat, 0.0)) - 1.0
        room = 1.0 - excess / headroom
    with np.errstate(divide="ignore"):
        saturated = log_sat - headroom / p * np.log(np.where(room > LEAST_ROOM, room, 0.0))
    log_load = np.where(excess > 0.0, saturated, y / p)
    if bend > 0.0:
        drop = np.minimum(y - p * log_on, 0.0)
        # the root that stays exact for small drops: no difference of near equals
        turn_on = log_on + 2.0 * drop / (p + np.sqrt(p * p - 4.0 * bend * drop))
        log_load = np.where(drop < 0.0, turn_on, log_load)
    out[on] = np.exp(log_load)
    return out


def ratio_kernel(siemens: Array, reference_s: float, gain: float) -> Array:
    """Return the measured share of the supply, ``gain g_ij / (G_ref + sum_k g_kj)``."""
    return np.asarray(gain * siemens / (reference_s + siemens.sum(axis=0)))


def siemens_kernel(
    ratio: Array, reference_s: float, gain: float
) -> tuple[Array, NDArray[np.bool_]]:
    """Return the conductances and which columns are possible: `ratio_kernel` inverted."""
    with np.errstate(over="ignore"):  # no supply gives such sums: not possible
        true = ratio / gain
        left = 1.0 - true.sum(axis=0)
    possible = (left > 0.0) & (left < np.inf)
    valid = np.broadcast_to(possible, ratio.shape).copy()
    siemens = np.where(valid, true * (reference_s / np.where(possible, left, 1.0)), 0.0)
    return siemens, valid
