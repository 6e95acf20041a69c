"""How the experiments measure discs: by the calibration curve alone, or decoupled."""

from __future__ import annotations

from typing import Literal

import numpy as np

from tactile_graph import Pipeline, load

MOST_CALIBRATED_G = 750.0
"""On each of four elements: figure 2.15 ends at 3000 g."""

Kind = Literal["curve", "decoupled", "footprint"]
"""How discs are measured: as in the thesis; with the weight by the circuit's inverse and the force
law; and with the area of the footprint's cells besides."""
PIPELINES: dict[Kind, str] = {
    "curve": "thesis-identify",
    "decoupled": "identify-decoupled",
    "footprint": "identify-footprint",
}
"""Whose node ``features`` measures so."""


def weighing(kind: Kind, seed: int = 0, pad: str = "thesis") -> Pipeline:
    """Return the pipeline whose node ``features`` measures discs.

    Parameters
    ----------
    kind : "curve", "decoupled" or "footprint"
    seed : int
        Of the calibration's placements.
    pad : str
        On which it is calibrated.
    """
    pipeline = load(PIPELINES[kind])
    if kind != "curve":
        return pipeline
    return pipeline.with_settings({"grams.curve": calibration_curve(seed, pad)})


def calibration_curve(seed: int = 0, pad: str = "thesis", groups: int = 9) -> list[list[float]]:
    """Return points (volts, grams) of an element, as the thesis calibrated the array.

    Parameters
    ----------
    seed : int
    pad : str
    groups : int
        Groups of four neighbours loaded at random places; their mean volts are taken.

    Notes
    -----
    Thesis section 2.4.2 and figures 2.15 to 2.18. The mean of the groups is joined by straight
    lines; the thesis smooths it by a polynomial of the fifth order. What reads more than the
    heaviest load it was calibrated with counts as that load.
    """
    from tactile_graph_pads.pad import load_pad

    bench, rng = load_pad(pad), np.random.default_rng(seed)
    built = bench.built(rng)
    fields = bench.unevenness.draw(bench.geometry, rng)
    grams = np.geomspace(5.0, MOST_CALIBRATED_G, 40)
    rows, columns = bench.geometry.shape
    volts = np.zeros(grams.size)
    for _ in range(groups):
        i, j = int(rng.integers(rows - 1)), int(rng.integers(columns - 1))
        gains = bench.unevenness.gains(fields, bench.unevenness.draw(bench.geometry, rng))
        part = gains[i : i + 2, j : j + 2] + 1e-3  # four voids would bear nothing at all
        for k, each in enumerate(grams):
            load = np.zeros(bench.geometry.shape)
            load[i : i + 2, j : j + 2] = 4.0 * each * part / part.sum()
            read = bench.volts_of(bench.conductance_s(load, built))
            volts[k] += read[i : i + 2, j : j + 2].mean() / groups
    rising = np.flatnonzero(np.diff(np.maximum.accumulate(volts), prepend=0.0) > 1e-6)
    curve = [[float(volts[k]), float(grams[k])] for k in rising]
    return [*curve, [bench.circuit.supply_v, curve[-1][1]]]
