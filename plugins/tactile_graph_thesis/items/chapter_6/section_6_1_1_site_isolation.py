"""Section 6.1.1, figure 6.1: whether site isolation takes the coupling away."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from tactile_graph_pads.circuits import Feedback
from tactile_graph_pads.circuits.nodal import node_voltages
from tactile_graph_pads.pad import Pad
from tactile_graph_thesis.drawing.bars import bars
from tactile_graph_thesis.item import Finding, Item, Made, Table
from tactile_graph_thesis.work import Work

Array = NDArray[np.float64]
COUNTS = (1, 4, 9, 36, 100)
"""Elements under the same load, a square of them."""
LOAD_G = 100.0
AT = (3, 3)
"""The element that is read, a corner of the square."""
DRIVER_OHM = 100.0
"""Of each row, in the last two circuits."""
LEFT = 0.1
"""Share of the loss from which the circuit does not counter the effect."""


def _site_isolation(work: Work) -> Made:
    drivers = f"drivers of {DRIVER_OHM:g} ohm"
    readings: dict[str, Callable[[Array], float]] = {
        "divider": lambda s: float(work.pad.circuit.ratio(s)[AT]),
        "isolated": lambda s: fed_back_ratio(s, AT, work.pad.circuit.bias_ohm),
        f"isolated, {drivers}": lambda s: fed_back_ratio(
            s, AT, work.pad.circuit.bias_ohm, DRIVER_OHM
        ),
        f"virtual ground, {drivers}": lambda s: float(Feedback(driver_ohm=DRIVER_OHM).ratio(s)[AT]),
    }
    lost = {name: _lost_percent(work.pad, read) for name, read in readings.items()}
    groups = {f"{n} elements": {name: of[n] for name, of in lost.items()} for n in COUNTS[1:]}
    rows = [(n, *(of[n] for of in lost.values())) for n in COUNTS]
    return Made(
        findings=tuple(
            counters(lost["divider"], of, said)
            for of, said in zip(
                list(lost.values())[1:],
                (
                    "site isolation",
                    f"(not in the thesis) with row {drivers} too, site isolation",
                    f"(not in the thesis) with row {drivers}, virtual ground at each column",
                ),
                strict=True,
            )
        ),
        table=Table(("elements", *(f"{name}_percent lost" for name in lost)), rows),
        figure=bars(groups, "reading lost to the others / %", f"{LOAD_G:g} g on each element"),
    )


def fed_back_ratio(
    siemens: Array, at: tuple[int, int], bias_ohm: float, driver_ohm: float = 0.0
) -> float:
    """Return what an element reads, in shares of the supply, while idle rows are fed just that.

    Parameters
    ----------
    siemens : ndarray, shape (rows, columns)
    at : (int, int)
        Row and column of the element.
    bias_ohm : float
        From its column to ground; the other columns are open.
    driver_ohm : float
        Resistance of each row's driver.

    Notes
    -----
    The reading is linear in the supply and in what is fed: ``v = a + b v``, so ``a / (1 - b)``.
    """
    rows, columns = siemens.shape
    n = rows + columns
    ground, supply, fed = n, n + 1, n + 2
    source = [supply if a == at[0] else fed for a in range(rows)]
    row = list(range(rows)) if driver_ohm else source
    nets = [(row[a], rows + b, siemens[a, b]) for a in range(rows) for b in range(columns)]
    nets += [(a, source[a], 1.0 / driver_ohm) for a in range(rows) if driver_ohm]
    nets.append((rows + at[1], ground, 1.0 / bias_ohm))
    of_supply, of_fed = (
        node_voltages(n + 3, nets, {ground: 0.0, supply: on, fed: 1.0 - on})[rows + at[1]]
        for on in (1.0, 0.0)
    )
    return float(of_supply / (1.0 - of_fed))


def _lost_percent(pad: Pad, read: Callable[[Array], float]) -> dict[int, float]:
    """Return how much less an element reads among others than alone, by their number."""
    found, alone = {}, math.nan
    for n in COUNTS:
        side = math.isqrt(n)
        load = np.zeros(pad.geometry.shape)
        load[AT[0] : AT[0] + side, AT[1] : AT[1] + side] = LOAD_G
        reading = read(pad.conductance_s(load))
        alone = reading if n == 1 else alone
        found[n] = round(100.0 * (1.0 - reading / alone), 9) + 0.0  # nor is it -0
    return found


def counters(
    divider: dict[int, float], isolated: dict[int, float], said: str = "site isolation"
) -> Finding:
    """Return whether a circuit loses a small part of what the divider does.

    Parameters
    ----------
    divider, isolated : dict
        Number of loaded elements -> reading lost, in percent.
    said : str
        Which circuit.
    """
    most = max(divider)
    return Finding(
        f"{said} counters the coupling effect",
        f"of {most} elements each loses {isolated[most]:.1f} % to the others, {divider[most]:.0f} "
        "% in the divider",
        f"{100 * LEFT:.0f} % of the loss left, or no loss in the divider",
        isolated[most] < LEFT * divider[most],
    )


ITEMS = (
    Item(
        "site-isolation",
        "Circuit against the coupling",
        "What an element loses to others loaded alike: in the divider, with idle rows fed what it "
        "reads as figure 6.1 proposes, and with each column held at virtual ground instead.",
        _site_isolation,
        "The thesis proposes the circuit and has not built it.",
        after="6.1.1",
    ),
)
