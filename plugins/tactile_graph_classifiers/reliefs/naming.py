"""How badly presses fit reliefs."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from tactile_graph_classifiers.reliefs.pad_reading import PadReading
from tactile_graph_classifiers.reliefs.presses import Presses
from tactile_graph_classifiers.reliefs.relief import Relief, begun_with, followed, starts, still

Array = NDArray[np.float64]


def misfits_to(reliefs: Sequence[Relief], pad: PadReading, presses: Presses) -> Array:
    """Return the misfit of each press to each relief, shape (n, K).

    That beyond what still cells have, and one for each cell that reads.
    """
    weights = pad.weights(presses)
    less, more = still(presses, weights)
    out = np.empty((len(presses.values), len(reliefs)))
    for k in range(len(out)):
        for o, relief in enumerate(reliefs):
            first = begun_with(relief, starts(relief, presses, k), presses, k, weights, pad)
            misfit, _ = followed(relief, first, presses, k, weights, pad)
            out[k, o] = max(misfit - less[k], 0.0) + more[k]
    return out
