"""Section 6.1.1, figure 6.1: whether site isolation takes the coupling away."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from tactile_graph_pads.circuits import Feedback
from tactile_graph_pads.pad import Pad
from tactile_graph_thesis.drawing.bars import bars
from tactile_graph_thesis.item import Finding, Item, Made, Table
from tactile_graph_thesis.work import Work

COUNTS = (1, 4, 9, 36, 100)
"""Elements under the same load, a square of them."""
LOAD_G = 100.0
DRIVER_OHM = 100.0
"""Of each row, in the third circuit."""
LEFT = 0.1
"""Share of the loss from which the circuit does not counter the effect."""


def _site_isolation(work: Work) -> Made:
    pads = {
        "divider": work.pad,
        "isolated": replace(work.pad, circuit=Feedback()),
        f"isolated, drivers of {DRIVER_OHM:g} ohm": replace(
            work.pad, circuit=Feedback(driver_ohm=DRIVER_OHM)
        ),
    }
    lost = {name: _lost_percent(pad) for name, pad in pads.items()}
    groups = {f"{n} elements": {name: of[n] for name, of in lost.items()} for n in COUNTS[1:]}
    rows = [(n, *(of[n] for of in lost.values())) for n in COUNTS]
    return Made(
        findings=tuple(
            counters(lost["divider"], of, said)
            for of, said in zip(
                list(lost.values())[1:],
                ("", f"(not in the thesis) with row drivers of {DRIVER_OHM:g} ohm too, "),
                strict=True,
            )
        ),
        table=Table(("elements", *(f"{name}_percent lost" for name in lost)), rows),
        figure=bars(groups, "reading lost to the others / %", f"{LOAD_G:g} g on each element"),
    )


def _lost_percent(pad: Pad) -> dict[int, float]:
    """Return how much less an element reads among others than alone, by their number."""
    found, alone = {}, math.nan
    for n in COUNTS:
        side = int(np.sqrt(n))
        load = np.zeros(pad.geometry.shape)
        load[3 : 3 + side, 3 : 3 + side] = LOAD_G
        read = pad.forward(load)[3, 3]
        alone = read if n == 1 else alone
        found[n] = float(100.0 * (1.0 - read / alone))
    return found


def counters(divider: dict[int, float], isolated: dict[int, float], said: str = "") -> Finding:
    """Return whether a circuit loses a small part of what the divider does.

    Parameters
    ----------
    divider, isolated : dict
        Number of loaded elements -> reading lost, in percent.
    said : str
        Put before the words.
    """
    most = max(divider)
    return Finding(
        f"{said}site isolation counters the coupling effect",
        f"of {most} elements each loses {isolated[most]:.1f} % to the others, {divider[most]:.0f} "
        "% in the divider",
        f"{100 * LEFT:.0f} % of the loss left, or no loss in the divider",
        isolated[most] < LEFT * divider[most],
    )


ITEMS = (
    Item(
        "site-isolation",
        "Circuit against the coupling",
        "What an element loses to others loaded alike, in the divider and with each column held at "
        "virtual ground as figure 6.1 proposes.",
        _site_isolation,
        "The thesis proposes the circuit and has not built it.",
        after="6.1.1",
    ),
)
