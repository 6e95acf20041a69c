"""Identification errors averaged over several simulated pads: figures 4.38 to 4.43."""

from __future__ import annotations

from typing import Any

import numpy as np

from tactile_graph_thesis.measure.identification_tables import Curve, error_curves


def mean_curves(seeds: range, kind: str = "curve", **settings: Any) -> list[Curve]:
    """Return the identification errors of figures 4.38 to 4.43, averaged over pads.

    Parameters
    ----------
    seeds : range
        One simulated pad each.
    kind : "curve" or "decoupled"
        How weights are found.
    **settings
        Others of `error_curves`.
    """
    runs = [error_curves(kind, seed=seed, **settings) for seed in seeds]
    return [
        Curve(
            same[0].pair,
            same[0].differences_g,
            {s: np.mean([c.error[s] for c in same], axis=0) for s in same[0].error},
        )
        for same in zip(*runs, strict=True)
    ]
