"""Table 5.2: radii of two discs by the hull of the line field and by circle-3."""

from __future__ import annotations

import numpy as np

from tactile_graph_thesis.drawing.beside import beside_figure
from tactile_graph_thesis.item import Compared, Finding, Item, Made, Table
from tactile_graph_thesis.measure.restorations import (
    ENCLOSED,
    EVERY_LINE,
    HEURISTIC,
    LEAST_ENERGY,
    WAYS,
    RadiusRow,
    table_5_2,
)
from tactile_graph_thesis.numbers import error_table
from tactile_graph_thesis.work import Work

READINGS, QUICK_READINGS = 100, 15
"""Of each disc."""
WORSE_CM = 0.1
"""By how much one way may err more that does as well: the last digit of the thesis' table."""
_BY_LINES = (EVERY_LINE, ENCLOSED, LEAST_ENERGY)
"""The ways on volts, beside each of which the thesis' number stands."""


def _table_5_2(work: Work) -> Made:
    thesis = error_table("table-5.2")
    n = min(QUICK_READINGS if work.quick else READINGS, work.readings)
    rows = table_5_2(work.seed, n, work.pad_name)
    compared = []
    for row in rows:
        _, lines, heuristic = thesis.values[thesis.objects.index(row.name)]
        said = dict.fromkeys(_BY_LINES, float(lines)) | {HEURISTIC: float(heuristic)}
        compared += [
            Compared(f"{row.name}, radius by {way}", "cm", row.mean_cm(way), said.get(way))
            for way in WAYS
        ]
    columns = ("object", "true_cm", *(f"{w}_{u}" for w in WAYS for u in ("cm", "sd_cm")))
    data = [
        (r.name, r.actual_cm, *(v for w in WAYS for v in (r.mean_cm(w), r.sd_cm(w)))) for r in rows
    ]
    return Made(
        tuple(compared),
        (as_good(rows, ENCLOSED),),
        Table(columns, data),
        beside_figure(compared, "Radii by lines and by circle-3", "radius"),
        notes=(f"Means over {n} readings of each disc.",),
    )


def as_good(rows: tuple[RadiusRow, ...], way: str) -> Finding:
    """Return whether a way errs no more than circle-3 does.

    Parameters
    ----------
    rows : tuple of RadiusRow
    way : str
    """
    ours, other = (np.concatenate([r.error_cm(w) for r in rows]) for w in (way, HEURISTIC))
    more = float(np.nanmean(ours - other))
    alike = float(np.mean([abs(r.mean_cm(way) - r.mean_cm(HEURISTIC)) for r in rows]))
    return Finding(
        "with a convex hull the Bayesian way does as well as the heuristic one",
        f"a radius is off by {np.nanmean(ours):.2f} cm by {way}, by {np.nanmean(other):.2f} cm by "
        f"circle-3, the means of the two are {alike:.2f} cm apart",
        f"an error more than {WORSE_CM:g} cm larger",
        more <= WORSE_CM,
    )


ITEMS = (
    Item(
        "table-5.2",
        "Radii by both ways",
        "Radius of both discs by the hull of the line field and by circle-3.",
        _table_5_2,
        "The thesis gives one number for each, from one reading as it seems; ours are means. The "
        "sampler leaves lines astray, which make the hull of every line too large; what the lines "
        "enclose is free of them. On the logarithm lines go around every cell that is touched, "
        "and lines run between cells, where the points that circle-3 fits are centres of cells.",
        after="5.13",
    ),
)
