"""A comparison that shows itself: as tables in notebooks, as one line where only text goes."""

from __future__ import annotations

from html import escape
from itertools import groupby

from tactile_graph_compare.output.tables import LEFT, Table, heading, saving, tables
from tactile_graph_compare.records.comparison import Comparison

_CELL = "padding:.15em .6em;text-align:"


class ShownComparison(Comparison):
    """A `Comparison` as a user holds it."""

    def __repr__(self) -> str:
        return f"<Comparison of {', '.join(self.labels)}: {heading(self)}>"

    def _repr_html_(self) -> str:
        parts = [f"<p><b>{escape(heading(self))}</b></p>"]
        parts += [f"<p>Note: {escape(note)}</p>" for note in self.notes]
        parts += [_table(table) for table in tables(self)]
        parts.append(f"<p>{escape(saving(self))}</p>")
        return f'<div style="font:12px sans-serif">{"".join(parts)}</div>'


def _table(table: Table) -> str:
    head = "".join(_cell("th", name, name) for name in table.columns)
    body = "".join(_group(table, list(rows)) for _, rows in groupby(table.rows, lambda r: r[0]))
    note = f"<p>{escape(table.note)}</p>" if table.note else ""
    return (
        f"<p><b>{escape(table.title)}</b></p>"
        f'<table style="border-collapse:collapse"><tr>{head}</tr>{body}</table>{note}'
    )


def _group(table: Table, rows: list[tuple[str, ...]]) -> str:
    """Return rows of one quantity, which is said in the first of them, under a rule."""
    made = []
    for i, row in enumerate(rows):
        told = ("" if i and table.columns[0] == "quantity" else row[0], *row[1:])
        cells = "".join(_cell("td", *pair) for pair in zip(table.columns, told, strict=True))
        rule = "" if i else ' style="border-top:1px solid #8888"'
        made.append(f"<tr{rule}>{cells}</tr>")
    return "".join(made)


def _cell(kind: str, column: str, text: str) -> str:
    side = "left" if column in LEFT else "right"
    return f'<{kind} style="{_CELL}{side}">{escape(text)}</{kind}>'
