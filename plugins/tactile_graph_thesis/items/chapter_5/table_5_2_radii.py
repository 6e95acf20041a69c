"""Table 5.2: radii of two discs by the hull of the line field and by circle-3."""

from __future__ import annotations

import numpy as np

from tactile_graph_thesis.drawing.beside import beside_figure
from tactile_graph_thesis.item import Compared, Finding, Item, Made, Table
from tactile_graph_thesis.measure.restorations import RadiusRow, table_5_2
from tactile_graph_thesis.numbers import error_table
from tactile_graph_thesis.work import Work

READINGS, QUICK_READINGS = 100, 15
"""Of each disc."""


def _table_5_2(work: Work) -> Made:
    thesis = error_table("table-5.2")
    n = min(QUICK_READINGS if work.quick else READINGS, work.readings)
    rows = table_5_2(work.seed, n, work.pad_name)
    compared = []
    for row in rows:
        known = thesis.values[thesis.objects.index(row.name)]
        for way, ours, theirs in (
            ("the line field's hull", row.line_hull_cm, float(known[1])),
            ("the line field's hull, moved in", row.bayesian_cm, None),
            ("circle-3", row.heuristic_cm, float(known[2])),
        ):
            compared.append(Compared(f"{row.name}, radius by {way}", "cm", ours[0], theirs))
    columns = (
        "object",
        "true_cm",
        "lines_cm",
        "lines_sd_cm",
        "lines moved in_cm",
        "lines moved in_sd_cm",
        "circle-3_cm",
        "circle-3_sd_cm",
    )
    data = [(r.name, r.actual_cm, *r.line_hull_cm, *r.bayesian_cm, *r.heuristic_cm) for r in rows]
    return Made(
        tuple(compared),
        (_as_good(rows),),
        Table(columns, data),
        beside_figure(compared, "Radii by lines and by circle-3", "radius"),
        notes=(f"Means over {n} readings of each disc.",),
    )


def _as_good(rows: tuple[RadiusRow, ...]) -> Finding:
    off = {
        way: float(np.mean([abs(getattr(r, way)[0] - r.actual_cm) for r in rows]))
        for way in ("line_hull_cm", "bayesian_cm", "heuristic_cm")
    }
    return Finding(
        "with a convex hull the Bayesian way does as well as the heuristic one",
        f"the mean radius is off by {off['line_hull_cm']:.2f} cm by lines, by "
        f"{off['heuristic_cm']:.2f} cm by circle-3; by lines moved in by what border cells leave "
        f"uncovered {off['bayesian_cm']:.2f} cm",
        off["line_hull_cm"] <= 1.5 * off["heuristic_cm"],
    )


ITEMS = (
    Item(
        "table-5.2",
        "Radii by both ways",
        "Radius of both discs by the hull of the line field and by circle-3.",
        _table_5_2,
        "The thesis gives one number for each, from one reading as it seems; ours are means. "
        "Lines run between cells, so a hull of lines encloses what border cells leave uncovered, "
        "where the points that circle-3 fits are centres of cells.",
        after="5.13",
    ),
)
