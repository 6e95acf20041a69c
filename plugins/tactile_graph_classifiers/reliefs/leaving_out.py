"""How far presses are from their own object's relief, learned without them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from tactile_graph_classifiers.reliefs.laying import begun_from
from tactile_graph_classifiers.reliefs.learning import SOFT, Say, Stage, staged
from tactile_graph_classifiers.reliefs.naming import misfits_to
from tactile_graph_classifiers.reliefs.pad_reading import PadReading
from tactile_graph_classifiers.reliefs.presses import Presses
from tactile_graph_classifiers.reliefs.relief import Relief

Array = NDArray[np.float64]
PARTS = 5
"""In so many runs of successive presses an object's are left out: neighbours may be alike for
reasons that will not come again."""
FEWEST = 4
"""Presses that must be left to learn from."""
STAGES = (Stage(0.1, 4.0, 20), Stage(0.06, 2.0, 20), Stage(0.04, 1.0, 30), Stage(SOFT, 1.0, 50))


def parts_of(n: int) -> NDArray[np.intp]:
    """Return for each of n successive presses in which part it is left out."""
    return np.arange(n) * min(PARTS, n) // max(n, 1)


def left_out_misfits(
    reliefs: Sequence[Relief], all_presses: Sequence[Presses], pad: PadReading, say: Say
) -> list[Array]:
    """Return the misfit of each press to its own relief learned without it, shape (n,) each.

    NaN where too few would be left. Gains, variances and law stay those learned of all, and other
    presses begin where they were found to lie.
    """
    out = [np.full(len(presses.values), np.nan) for presses in all_presses]
    for part in range(PARTS):
        for relief, presses, found in zip(reliefs, all_presses, out, strict=True):
            left = parts_of(len(found)) == part
            if not left.any() or np.count_nonzero(~left) < FEWEST:
                continue
            others = presses.chosen(~left)
            without = begun_from(relief, others, ~left, STAGES[0].soft)
            staged(without, others, pad, STAGES, without.trust(others))
            found[left] = misfits_to([without], pad, presses.chosen(left))[:, 0]
        say(f"presses left out: part {part + 1} of {PARTS}")
    return out
