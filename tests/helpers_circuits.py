"""Conductances to try circuits on, and their exact answers by nodal analysis."""

from fractions import Fraction

import numpy as np

from tactile_graph_pads.circuits.nodal import measured_ratio


def spread_siemens(seed, shape=(16, 16), low_ohm=1e3, high_ohm=1e6):
    """Conductances spread evenly in the logarithm."""
    rng = np.random.default_rng(seed)
    return 1.0 / np.exp(rng.uniform(np.log(low_ohm), np.log(high_ohm), shape))


def exact_ratio(kind, siemens, bias_ohm, driver_ohm=0.0, mux_ohm=0.0):
    """What a scan measures, in rational arithmetic: right to the last digit."""
    exact = [[Fraction(float(g)) for g in row] for row in siemens]
    parts = (Fraction(bias_ohm), Fraction(driver_ohm), Fraction(mux_ohm))
    return np.array([[float(v) for v in row] for row in measured_ratio(kind, exact, *parts)])
