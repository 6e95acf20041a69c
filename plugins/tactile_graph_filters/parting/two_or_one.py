"""How much more likely two sets of cells are two objects than one."""

from __future__ import annotations

import numpy as np

from tactile_graph.compiled import compiled_later
from tactile_graph_filters.parting.basin_groups import DIAGONAL
from tactile_graph_filters.parting.hull_terms import (
    AREA,
    CELLS,
    LOGS,
    LONG,
    NOTCHES,
    WEAK,
    Levels,
    hull_area,
    hull_terms,
)
from tactile_graph_filters.parting.partition import Partition, Reals

NAMES = (
    "constant", "hull gap", "notches", "weak cells", "seam", "seam's readings", "length",
    "inverse of fewer cells", "log of fewer cells", "log of all cells",
)  # fmt: skip
"""Of the terms in `cut_terms`."""
WEIGHTS = np.array([3.68, 3.08, 2.44, 9.55, -1.42, -0.659, -3.24, -22.6, -1.84, -0.211])
"""What each one weighs: fitted by logistic regression to the best cuts of single objects and of
touching pairs, simulated on the thesis' pad; ``benchmarks/split_weights.py --fit`` does it anew."""
NO_SEAM = -1.0
"""Taken for the seam's logarithm where the two do not touch."""


@compiled_later
def log_odds(cells: Partition, one: int, two: int, levels: Levels, both: Reals) -> float:
    """Return the log odds that the cells of ``one`` and of ``two`` are two objects.

    What speaks for two: the hull of both is larger than their own hulls, off cells on its rim
    and weak ones within it vanish with a cut, the seam between them is short and its readings
    are low, neither is long or small.

    ``both`` are the terms of the two together, from `hull_terms`. Nobody else's cells matter. Of
    the best cut there is, the result is a log odds; of any cut, a score.
    """
    terms = cut_terms(cells, one, two, levels, both)
    odds = 0.0
    for k in range(len(terms)):
        odds += WEIGHTS[k] * terms[k]
    return odds


@compiled_later
def cut_terms(cells: Partition, one: int, two: int, levels: Levels, both: Reals) -> Reals:
    """Return what `log_odds` weighs, shape (10,), in the order of `NAMES`."""
    a = hull_terms(cells, one, one, levels)
    b = hull_terms(cells, two, two, levels)
    length, on_seam, logs = seam(cells, one, two, levels)
    n = both[CELLS]
    fewer, root = min(a[CELLS], b[CELLS]), np.sqrt(n)
    terms = np.ones(10)
    terms[1] = (both[AREA] - a[AREA] - b[AREA]) / root
    terms[2] = (both[NOTCHES] - a[NOTCHES] - b[NOTCHES]) / root
    terms[3] = (both[WEAK] - a[WEAK] - b[WEAK]) / root
    terms[4] = length / root
    terms[5] = logs / on_seam - both[LOGS] / n if on_seam > 0 else NO_SEAM
    terms[6] = max(a[LONG], b[LONG])
    terms[7] = 1.0 / fewer
    terms[8] = np.log(fewer)
    terms[9] = np.log(n)
    return terms


@compiled_later
def most_odds(
    cells: Partition, one: int, two: int, levels: Levels, both: Reals, fewer: int
) -> float:
    """Return what `log_odds` is not above, in less time; ``fewer`` cells has the smaller of both.

    Neither of the two is taken to be long, to have notches, or to be weak within: by the signs of
    `WEIGHTS` each makes two objects less likely.
    """
    n = both[CELLS]
    root = np.sqrt(n)
    apart = both[AREA] - hull_area(cells.owner, one) - hull_area(cells.owner, two)
    odds = WEIGHTS[0] + (WEIGHTS[1] * apart) / root
    odds += (WEIGHTS[2] * both[NOTCHES] + WEIGHTS[3] * both[WEAK]) / root
    odds += WEIGHTS[7] / fewer + WEIGHTS[8] * np.log(fewer) + WEIGHTS[9] * np.log(n)
    length, on_seam, logs = seam(cells, one, two, levels)
    readings = logs / on_seam - both[LOGS] / n if on_seam > 0 else NO_SEAM
    return float(odds + WEIGHTS[4] * length / root + WEIGHTS[5] * readings)


@compiled_later
def seam(cells: Partition, one: int, two: int, levels: Levels) -> tuple[float, float, float]:
    """Return length, number of cells, and sum of their readings' logarithms along the seam."""
    owner, values, full = cells.owner, cells.values, levels.full
    rows, columns = owner.shape
    length = on_seam = logs = 0.0
    for i in range(rows):
        for j in range(columns):
            mine = owner[i, j]
            if mine != one and mine != two:
                continue
            other = two if mine == one else one
            touches = False
            for k in range(max(0, i - 1), min(rows, i + 2)):
                for m in range(max(0, j - 1), min(columns, j + 2)):
                    if owner[k, m] != other:
                        continue
                    touches = True
                    if mine == one:
                        lower = min(values[i, j], values[k, m])
                        weight = 1.0 if k == i or m == j else DIAGONAL
                        length += weight * (min(1.0, lower / full) if full > 0 else 1.0)
            if touches:
                on_seam += 1.0
                logs += np.log(max(values[i, j], levels.floor))
    return length, on_seam, logs
