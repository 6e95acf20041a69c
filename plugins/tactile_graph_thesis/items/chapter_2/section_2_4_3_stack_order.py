"""Section 2.4.3: the weight read of two objects, one on the other, and the other way round."""

from __future__ import annotations

from itertools import combinations
from typing import Any

import numpy as np

from tactile_graph import load
from tactile_graph_thesis.drawing.bars import bars
from tactile_graph_thesis.item import Finding, Item, Made, Table
from tactile_graph_thesis.numbers import error_table
from tactile_graph_thesis.work import Work

READINGS = 12
"""Of each order."""
STAND_CM = 0.5
"""How far off the middle the upper object stands, per axis (standard deviation)."""
CHANGED = 0.05
"""Share of the weight by which readings must differ to have changed."""


def _stack_order(work: Work) -> Made:
    table = error_table("table-2.2")
    objects = dict(zip(table.objects, table.values.tolist(), strict=True))
    groups, rows = {}, []
    for one, other in combinations(list(objects)[:4], 2):
        total = objects[one][0] + objects[other][0]
        read = {
            "the broader below": _weight_g(work, objects[one], objects[other]),
            "the narrower below": _weight_g(work, objects[other], objects[one]),
        }
        pair = f"{one} and {other[-1]}, {total:.0f} g"
        groups[pair] = {way: 100.0 * grams / total for way, grams in read.items()}
        rows.append((pair, total, *read.values()))
    changed = {
        pair: abs(a / b - 1.0) for pair, (a, b) in ((p, g.values()) for p, g in groups.items())
    }
    return Made(
        findings=(changes(changed),),
        table=Table(("objects", "weight_g", "broader below_g", "narrower below_g"), rows),
        figure=bars(
            groups, "weight read / % of the true one", "One on the other, and changed round"
        ),
    )


def _weight_g(work: Work, below: list[float], above: list[float]) -> float:
    """Return the mean weight that the calibration curve gives for two objects."""
    thing: dict[str, Any] = {
        "shape": "disc", "weight_g": below[0], "radius_cm": below[1],
        "stacked_g": [above[0]], "stack_offset_cm": STAND_CM,
    }  # fmt: skip
    pipeline = load("thesis-identify").with_source(
        "simulate", scene={"objects": [thing]}, frames=READINGS, pad=work.pad_name
    )
    results = pipeline.stream(only=["grams"], seed=work.seed)
    return float(np.mean([r["grams"].filled(0.0).sum() for r in results]))


def changes(changed: dict[str, float]) -> Finding:
    """Return whether readings change in many cases when two objects change places.

    Parameters
    ----------
    changed : dict
        Pair of objects -> share of the weight by which the readings differ.
    """
    many = sum(share > CHANGED for share in changed.values())
    words = f"from {100 * min(changed.values()):.0f} to {100 * max(changed.values()):.0f} %"
    return Finding(
        "in many cases the weight read changes when two objects on each other change places",
        f"by {words}; by more than {100 * CHANGED:.0f} % in {many} of {len(changed)} pairs",
        "fewer than half of the pairs that change so much",
        many >= 0.5 * len(changed),
    )


ITEMS = (
    Item(
        "stack-order",
        "Two objects on each other",
        "What two discs of table 2.2 weigh by the calibration curve, one on the other and the "
        "other way round.",
        _stack_order,
        "What changes is the footprint: it is the lower object's. Which pairs the thesis tried it "
        "does not say.",
        after="2.4.3",
    ),
)
