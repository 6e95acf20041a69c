"""Figure 2.2: resistance of an element against the force on it."""

from __future__ import annotations

import numpy as np

from tactile_graph_pads.calibration.plot import new_figure
from tactile_graph_pads.law import ForceLaw
from tactile_graph_thesis.item import Finding, Item, Made, Table
from tactile_graph_thesis.work import Work

LOADS_G = np.geomspace(1.0, 10_000.0, 81)
TOLD = ((100.0, 80e3), (2000.0, 1e3))
"""Loads in g and resistances in ohm that section 2.3.2 gives."""
OFF = 0.05
"""Share by which a resistance may be off what is told."""


def _figure_2_2(work: Work) -> Made:
    law = work.pad.law
    ohm = np.array([law.resistance_at(float(load)) for load in LOADS_G])
    figure = new_figure(6.4, 4.6)
    axes = figure.subplots()
    axes.loglog(LOADS_G, ohm, label=f"exponent {-law.power:.2f} between turn-on and saturation")
    axes.plot(*zip(*TOLD, strict=True), "o", color="C3", label="given in section 2.3.2")
    axes.set(xlabel="load on an element / g", ylabel="resistance / ohm", title="The force law")
    axes.grid(alpha=0.3, which="both")
    axes.legend()
    return Made(
        findings=(as_told(law), falls_throughout(ohm)),
        table=Table(
            ("load_g", "resistance_ohm"), list(zip(LOADS_G.tolist(), ohm.tolist(), strict=True))
        ),
        figure=figure,
    )


def as_told(law: ForceLaw) -> Finding:
    """Return whether the law goes through the loads and resistances that the text gives.

    Parameters
    ----------
    law : ForceLaw
    """
    found = [law.resistance_at(load) for load, _ in TOLD]
    words = ", ".join(
        f"{r / 1e3:.1f} kOhm at {g:g} g" for r, (g, _) in zip(found, TOLD, strict=True)
    )
    return Finding(
        "an element has 80 kOhm at 100 g and 1 kOhm at 2 kg",
        words,
        f"one of the two {100 * OFF:.0f} % off",
        all(abs(r / told - 1.0) < OFF for r, (_, told) in zip(found, TOLD, strict=True)),
    )


def falls_throughout(ohm: np.ndarray) -> Finding:
    """Return whether the resistance falls with the force all along.

    Parameters
    ----------
    ohm : ndarray, shape (loads,)
        At rising loads.
    """
    return Finding(
        "the resistance decreases with the force",
        f"from {ohm[0]:.3g} ohm at 1 g to {ohm[-1]:.0f} ohm at 10 kg",
        "a load at which it is no less than at a lower one",
        bool((np.diff(ohm) < 0.0).all()),
    )


ITEMS = (
    Item(
        "figure-2.2",
        "Resistance against force",
        "The law of an element on the pad, from its turn-on to its saturation.",
        _figure_2_2,
        "The thesis copies the maker's plot, of another size of element; the law goes through the "
        "two points its text gives.",
    ),
)
