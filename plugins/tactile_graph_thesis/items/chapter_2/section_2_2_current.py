"""Section 2.2: whether the circuit keeps an element's current below the maker's limit."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tactile_graph_pads.calibration.plot import new_figure
from tactile_graph_thesis.item import Finding, Item, Made, Table
from tactile_graph_thesis.work import Work

Array = NDArray[np.float64]
LIMIT_MA_CM2 = 1.0
"""Table 2.1."""
HEAVY_G = 20_000.0
"""The heaviest load on one element that table 2.1 allows."""
BIAS_OHM = np.geomspace(500.0, 100e3, 60)


def _current(work: Work) -> Made:
    pad = work.pad
    element_cm2 = pad.geometry.element_cm**2
    lone = pad.law.resistance_at(HEAVY_G)
    supply = pad.circuit.supply_v
    per_cm2 = 1e3 * supply / (lone + BIAS_OHM) / element_cm2
    ours = 1e3 * supply / (lone + _bias_ohm(work)) / element_cm2
    figure = new_figure(6.4, 4.2)
    axes = figure.subplots()
    axes.loglog(BIAS_OHM / 1e3, per_cm2, label=f"a lone element under {HEAVY_G / 1e3:g} kg")
    axes.axhline(LIMIT_MA_CM2, color="0.5", ls=":", label="the maker's limit")
    axes.plot(_bias_ohm(work) / 1e3, ours, "o", color="C3", label="the pad's bias resistor")
    axes.set(xlabel="bias resistor / kOhm", ylabel="current / mA per cm²", title="Largest current")
    axes.grid(alpha=0.3, which="both")
    axes.legend()
    rows = list(zip(BIAS_OHM.tolist(), per_cm2.tolist(), strict=True))
    return Made(
        findings=(below_the_limit(float(ours)),),
        table=Table(("bias_ohm", "current_mA_cm2"), rows),
        figure=figure,
    )


def _bias_ohm(work: Work) -> float:
    return float(work.pad.circuit.bias_ohm)


def below_the_limit(most_ma_cm2: float) -> Finding:
    """Return whether the largest current is allowed.

    Parameters
    ----------
    most_ma_cm2 : float
    """
    return Finding(
        "the current through each element is kept below 1 mA/cm²",
        f"at most {most_ma_cm2:.2f} mA/cm², a lone element under {HEAVY_G / 1e3:g} kg",
        f"{LIMIT_MA_CM2:g} mA/cm² or more under any load the maker allows",
        most_ma_cm2 < LIMIT_MA_CM2,
    )


ITEMS = (
    Item(
        "current-limit",
        "Current through an element",
        "The largest current, against the bias resistor, beside the limit of table 2.1.",
        _current,
        "The limit is given for each square centimetre of applied force; it is taken for the area "
        "of an element. The circuit is the pad's divider; the converters of section 2.2.2 have no "
        "resistor in series, and would pass more under a heavy load.",
        after="2.2",
    ),
)
