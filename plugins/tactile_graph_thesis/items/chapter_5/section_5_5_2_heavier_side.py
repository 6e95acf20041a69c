"""Section 5.5.2, item 4: whether the heavier side of an object can be told."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from tactile_graph.wires import Circle
from tactile_graph_fitters.orientation.heavier_side import heavier_side
from tactile_graph_thesis.drawing.bars import bars
from tactile_graph_thesis.item import Finding, Item, Made, Table
from tactile_graph_thesis.measure.bench import Bench
from tactile_graph_thesis.work import Work

Array = NDArray[np.float64]
OFFSETS_CM = (0.0, 0.5, 1.0, 2.0)
"""How far the load's centre truly lies from the disc's."""
DISC = Circle(10.4, 10.4, 6.9)
WEIGHT_G = 2950.0
READINGS, QUICK_READINGS = 60, 15
RIGHT_DEGREE = 45.0
"""Off by less than this a direction names the side."""


def _heavier(work: Work) -> Made:
    n = QUICK_READINGS if work.quick else READINGS
    bench = Bench(work.pad, np.random.default_rng(work.seed))
    off = {offset: _off_degree(bench, offset, n) for offset in OFFSETS_CM}
    groups = {
        f"{offset:g} cm off": {
            "right side": 100.0 * float(np.mean(degree < RIGHT_DEGREE)),
            "called clear": 100.0 * float(np.mean(clear)),
        }
        for offset, (degree, clear) in off.items()
    }
    rows = [(offset, *of.values()) for offset, of in zip(OFFSETS_CM, groups.values(), strict=True)]
    return Made(
        findings=(tells_the_side({o: d for o, (d, _) in off.items() if o >= 1.0}),),
        table=Table(("offset_cm", "right_percent", "clear_percent"), rows),
        figure=bars(groups, "readings / %", "The heavier side of a disc, decoupled, in grams"),
        notes=(f"{n} readings of each; right is a direction less than {RIGHT_DEGREE:g}° off, which "
               "chance alone names in one of four.",),
    )  # fmt: skip


def _off_degree(bench: Bench, offset_cm: float, n: int) -> tuple[Array, Array]:
    """Return how far the direction found is off, and whether it was called clear."""
    off, clear = [], []
    for _ in range(n):
        angle = float(bench.rng.uniform(-math.pi, math.pi))
        at = (offset_cm * math.cos(angle), -offset_cm * math.sin(angle))
        read = bench.volts(bench.load_g(DISC, WEIGHT_G, bench.gains(), at))
        grams = bench.pad.image(bench.pad.backward(read).load_g, "gram")
        found = heavier_side(grams, grams.mask(read >= 0.01), DISC)
        off.append(abs(math.degrees(math.remainder(found.angle_rad - angle, 2.0 * math.pi))))
        clear.append(float(found.clear))
    return np.array(off), np.array(clear)


def tells_the_side(off_degree: dict[float, Array]) -> Finding:
    """Return whether the side is mostly right.

    Parameters
    ----------
    off_degree : dict
        Offset of the load in cm -> how far the direction found is off, shape (readings,).
    """
    shares = {o: float(np.mean(d < RIGHT_DEGREE)) for o, d in off_degree.items()}
    words = ", ".join(f"{100 * s:.0f} % at {o:g} cm" for o, s in shares.items())
    return Finding(
        "the heavier side of an object can be obtained",
        f"right side told: {words}",
        "one of five readings wrong at an offset of 1 cm or more",
        min(shares.values()) > 0.8,
    )


ITEMS = (
    Item(
        "heavier-side",
        "The heavier side of an object",
        "A disc whose load lies off its centre by a known amount: how often the step heavier_side "
        "names the right side, and calls it clear.",
        _heavier,
        "The thesis expects it of a prior on the pressure; ours takes the centre of the decoupled "
        "load against the centre of the shape.",
        after="5.5.2",
    ),
)
