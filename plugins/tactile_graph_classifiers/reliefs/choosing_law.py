"""The law by which a pad reads, chosen by how well reliefs under it fit some of the presses."""

from __future__ import annotations

import copy
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from tactile_graph_classifiers.reliefs.descent import descend, kinks
from tactile_graph_classifiers.reliefs.learning import Say, improved, learned, unlearned_pad
from tactile_graph_classifiers.reliefs.pad_reading import LEAST, MOST, VARIANCES, Law, PadReading
from tactile_graph_classifiers.reliefs.presses import Presses
from tactile_graph_classifiers.reliefs.relief import Relief, stepped

BEGIN = Law(0.5, 1.0, 0.008)
OBJECTS = 6
"""By so many objects the law is chosen."""
SMALLER = 0.8
"""And those among the smaller ones, of this share: large ones take longer."""
SWEEPS = ((1.35, 0.12, 2.0), (1.16, 0.06, 1.4), (1.08, 0.03, 1.2))
"""Steps of blur (times), power (plus), and threshold (times), sweep by sweep."""
DESCENT, FIT = 25, 4
"""Steps in which reliefs, and then presses, are fitted anew under a law."""
COUNTED = 0.8
"""Share of an object's presses, the best fitted ones, whose misfit counts."""
BETTER = 5.0
"""By how much less misfit another law has to have."""


class Fitted(NamedTuple):
    """What reliefs come to under a law."""

    cost: float
    reliefs: list[Relief]


def chosen_law(all_presses: Sequence[Presses], say: Say) -> Law:
    """Return the law under which the presses of some objects fit reliefs best.

    Parameters
    ----------
    all_presses : sequence of Presses
        Of each object.
    say : callable
        Takes a line about what came of it.

    Notes
    -----
    Beginning with `BEGIN`, one of the three numbers after the other goes up or down as long as the
    least cost of reliefs and presses under it falls, in ever smaller steps. Gains and variances
    are learned between sweeps.
    """
    some = [all_presses[k] for k in _objects(all_presses)]
    pad = replace(unlearned_pad(some, BEGIN), variances=np.array(VARIANCES))
    reliefs = [learned(presses, pad) for presses in some]
    n_tried = 0
    for steps in SWEEPS:
        pad = improved(pad, reliefs, some, by_readings=True)
        here = _fitted(pad, reliefs, some)
        for key in range(3):
            for up in (True, False):
                while (law := _next(pad.law, key, steps[key], up)) is not None:
                    there = _fitted(replace(pad, law=law), here.reliefs, some)
                    stay = _fitted(pad, here.reliefs, some)
                    n_tried += 1
                    if there.cost > stay.cost - BETTER:
                        here = stay
                        break
                    pad, here = replace(pad, law=law), there
        reliefs = here.reliefs
    law = pad.law
    say(f"the pad's law, by {len(some)} objects and {n_tried} others tried: blur "
        f"{law.blur_cells:.2f} cells, power {law.power:.2f}, threshold {law.threshold:.4f} of full "
        "scale")  # fmt: skip
    return law


def _objects(all_presses: Sequence[Presses]) -> Iterator[int]:
    """Yield which objects the law is chosen by: of all sizes but the largest."""
    sizes = [float(np.median(presses.n_cells())) for presses in all_presses]
    order = np.argsort(sizes, kind="stable")
    order = order[: max(int(SMALLER * len(order)), min(OBJECTS, len(order)))]
    at = np.linspace(min(1, len(order) - OBJECTS), len(order) - 1, OBJECTS).clip(0)
    yield from sorted({int(order[int(k)]) for k in at})


def _next(law: Law, key: int, step: float, up: bool) -> Law | None:
    """Return the law a step on, None where that would be out of bounds."""
    if key == 1:
        value = law[key] + (step if up else -step)
    else:
        value = law[key] * (step if up else 1.0 / step)
    if not LEAST[key] < value < MOST[key]:
        return None
    return Law(*(value if k == key else old for k, old in enumerate(law)))


def _fitted(pad: PadReading, reliefs: Sequence[Relief], some: Sequence[Presses]) -> Fitted:
    """Return what reliefs come to under a pad's law after a few steps; they stay as they are."""
    cost, found = 0.0, []
    for relief, presses in zip(copy.deepcopy(list(reliefs)), some, strict=True):
        weights = pad.weights(presses)
        trust = relief.trust(presses)[:, None, None]
        descend(relief, presses, weights * trust, pad, DESCENT)
        for k, press in enumerate(relief.presses):
            fit = stepped(relief, press, presses, k, weights, pad, FIT)
            relief.misfits[k], relief.presses[k] = fit
        counted = max(int(COUNTED * len(relief.misfits)), 1)
        cost += float(np.sort(relief.misfits)[:counted].sum())
        cost += 2.0 * kinks(relief.depth / relief.usual)[0]
        found.append(relief)
    return Fitted(cost, found)
