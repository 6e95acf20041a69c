"""Cells that have a column for each axis of a force or a place: ``r0c0_x``, ``s3_fz``."""

from __future__ import annotations

import re

from tactile_graph.errors import one_of
from tactile_graph_sources.readers.tables.table import Table

_OF_AXIS = re.compile(r"(.*\d)[\W_]*(?:[\W_]([a-z]?[xyz])|([xyz]))", re.IGNORECASE)
"""The name of a cell, which ends with a number, and that of an axis behind it."""
FEWEST_CELLS, FEWEST_AXES = 2, 2


def axes_question(table: Table) -> str:
    """Return what to ask where each cell has several axes, of which a frame shows one."""
    known = {*table.named.roles.values(), *table.clocks, *table.labels}
    names = [n for k, n in enumerate(table.named.names) if k not in known]
    found = [m for n in names if (m := _OF_AXIS.fullmatch(n))]
    axes: dict[str, set[str]] = {}
    for m in found:
        axes.setdefault(m[2] or m[3], set()).add(m[1])
    cells = next(iter(axes.values()), set())
    alike = all(of_axis == cells for of_axis in axes.values())
    if len(axes) < FEWEST_AXES or len(cells) < FEWEST_CELLS or not alike:
        return ""
    if 2 * len(found) <= len(names):
        return ""
    axis = list(axes)[-1]
    return (
        f"its columns are {len(axes)} axes ({one_of(axes)}) of {len(cells)} cells "
        f"({found[0].string}, {found[1].string}, …), of which a frame has one; say which, such as "
        f"cells='*{axis}', and give rows and columns"
    )
