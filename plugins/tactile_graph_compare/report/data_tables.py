"""The comparison's tables as HTML, the best of each group in bold."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby

from tactile_graph_compare.output.tables import LEFT, Table
from tactile_graph_compare.records.comparison import Comparison
from tactile_graph_compare.report.badges import chip
from tactile_graph_compare.report.markup import Child, Html, scroll, tag

_LESS_IS_BEST = ("mean", "median", "95 %", "largest", "missing", "extra")
_SAYS = {"better": "good", "worse": "bad"}


def table(comparison: Comparison, shown: Table) -> Html:
    """Return a table with headers for its columns, groups and rows."""
    head = tag(
        "tr",
        (tag("th", c, scope="col", class_="words" if c in LEFT else None) for c in shown.columns),
    )
    numbers = {v.label: v.number for v in comparison.variants}
    bodies = []
    for name, group in groupby(shown.rows, key=lambda r: r[0] if _grouped(shown) else ""):
        rows = list(group)
        best = _best(shown, rows) if shown.title == "Absolute errors" or not _grouped(shown) else {}
        bodies.append(
            tag("tbody", (_row(shown, name, rows, i, best, numbers) for i in range(len(rows))))
        )
    note = shown.note.replace("* on", "★ on")
    note = note[:1].upper() + note[1:] if note[:1].isascii() else note
    made = tag(
        "table", tag("caption", tag("b", shown.title)), tag("thead", head), bodies, class_="data"
    )
    return tag(
        "div",
        scroll(shown.title, made),
        tag("p", f"{note}.", class_="note") if note else None,
        class_="tabled",
    )


def _grouped(shown: Table) -> bool:
    return shown.columns[0] == "quantity"


def _row(
    shown: Table,
    group: str,
    rows: Sequence[tuple[str, ...]],
    i: int,
    best: dict[int, float],
    numbers: dict[str, int],
) -> Html:
    cells: list[Child] = []
    for at, (column, value) in enumerate(zip(shown.columns, rows[i], strict=True)):
        if column == "quantity":
            if i == 0:
                span = len(rows)
                cells.append(tag("th", value, scope="rowgroup", rowspan=span, class_="words"))
        elif column in ("variant", "against"):
            label = value.removesuffix(" *")
            star = (
                tag("abbr", "★", title="on the Pareto front: none that answers as often beats it")
                if label != value
                else None
            )
            inner = [chip(numbers[label]) if label in numbers else None, " ", label, " ", star]
            kind = "th" if column == "variant" else "td"
            scope = "row" if column == "variant" else None
            cells.append(tag(kind, inner, scope=scope, class_="words"))
        else:
            kinds = [_SAYS.get(value, ""), "words" if column in LEFT else ""]
            known = _number(value)
            told: Child = tag("b", value) if known is not None and known == best.get(at) else value
            cells.append(tag("td", told, class_=" ".join(filter(None, kinds)) or None))
    return tag("tr", cells)


def _best(shown: Table, rows: Sequence[tuple[str, ...]]) -> dict[int, float]:
    """Return by column the least of the figures of which less is better."""
    found = {}
    for at, column in enumerate(shown.columns):
        known = [n for row in rows if (n := _number(row[at])) is not None]
        if column in _LESS_IS_BEST and len(set(known)) > 1:
            found[at] = min(known)
    return found


def _number(cell: str) -> float | None:
    try:
        value = float(cell)
    except ValueError:
        return None
    return None if value != value else value
