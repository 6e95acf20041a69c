"""Print a comparison for people."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby

from rich import box
from rich.cells import cell_len
from rich.console import Console
from rich.table import Table as RichTable
from rich.text import Text

from tactile_graph_compare.output.tables import (
    LEFT,
    Table,
    evolution_lines,
    heading,
    reason_lines,
    saving,
    tables,
)
from tactile_graph_compare.records.comparison import Comparison

GAP = 2
STYLES = {"better": "green", "worse": "red", "skipped": "yellow", "failed": "red", "strange": "red"}


def show(comparison: Comparison, console: Console) -> None:
    """Print tables and sentences, as wide as the console is."""
    console.print(Text(heading(comparison), style="bold"), soft_wrap=True)
    for note in comparison.notes:
        console.print(Text(f"note: {note}", style="yellow"), soft_wrap=True)
    gone: list[str] = []
    for table in tables(comparison):
        console.print()
        hidden = print_table(table, console)
        gone += [h for h in hidden if h not in gone]
    console.print()
    if gone:
        told = f"not shown, for want of width: {', '.join(gone)}; --json and --csv give all"
        console.print(Text(told, style="dim"), soft_wrap=True)
    for evolution in comparison.lineage:
        first, *rest = evolution_lines(evolution)
        console.print(Text(first, style="bold"), soft_wrap=True)
        for line in rest:
            word = next((w for w in STYLES if line.endswith(f", {w}")), "")
            console.print(Text(line, style=STYLES.get(word, "")), soft_wrap=True)
    if comparison.lineage:
        console.print()
    for state, text in reason_lines(comparison):
        style = STYLES.get(state, "dim")
        console.print(Text.assemble((f"{state:<8}", style), " ", text), soft_wrap=True)
    console.print(Text(saving(comparison), style="dim"), soft_wrap=True)


def print_table(table: Table, console: Console) -> list[str]:
    """Print a table, and return which columns a console has no room for.

    Where it has none even for those that have to stay, each row is a line with all of them.
    """
    narrow, gone = fitted(table, console.width)
    if _width(narrow) <= console.width:
        console.print(rich_table(narrow))
        return gone
    console.print(Text(table.title, style="bold"), soft_wrap=True)
    for line in row_lines(table):
        console.print(line)
    if table.note:
        console.print(Text(table.note, style="dim"))
    return []


def fitted(table: Table, width: int) -> tuple[Table, list[str]]:
    """Return the table without columns a console has no room for, and which these are."""
    gone: list[str] = []
    for column in table.can_go:
        if _width(table) <= width:
            break
        table = table.without(column)
        gone.append(column)
    return table, gone


def _width(table: Table) -> int:
    """Return how narrow a table can be."""
    return sum(_least(table, i) + GAP for i in range(len(table.columns)))


def _least(table: Table, column: int) -> int:
    """Return how narrow a column can be: words may stand one below the other, numbers not."""
    name = table.columns[column]
    cells = [name, *(row[column] for row in table.rows)]
    if name in LEFT and name != "quantity":
        cells = [word for cell in cells for word in cell.split()]
    return max(map(cell_len, cells))


def row_lines(table: Table) -> Iterator[Text]:
    """Yield a line for each row, its cells by name; above those of a quantity, that."""
    grouped = table.columns[0] == "quantity"
    for quantity, group in groupby(table.rows, key=lambda row: row[0] if grouped else ""):
        if grouped:
            yield Text(quantity, style="bold")
        for row in group:
            named = list(zip(table.columns, row, strict=True))[grouped:]
            line, parts = Text("  " * grouped), []
            if named[0][0] in LEFT:
                line.append(f"{named.pop(0)[1]}: ")
            for name, cell in named:
                if cell:
                    parts.append(Text(f"{name.strip()} ").append(cell, STYLES.get(cell, "")))
            yield line + Text(", ").join(parts)


def rich_table(table: Table) -> RichTable:
    """Return a table with a line between groups of rows."""
    made = RichTable(title=table.title, title_justify="left", title_style="bold", pad_edge=False,
                     box=box.SIMPLE_HEAD, padding=(0, 1, 0, 0), caption=table.note,
                     caption_justify="left", caption_style="dim")  # fmt: skip
    for i, name in enumerate(table.columns):
        words = name in LEFT
        made.add_column(name, justify="left" if words else "right", overflow="fold",
                        no_wrap=not words or name == "quantity",
                        min_width=_least(table, i))  # fmt: skip
    if table.columns[0] != "quantity":
        for row in table.rows:
            made.add_row(*row)
        return made
    for quantity, group in groupby(table.rows, key=lambda row: row[0]):
        for i, row in enumerate(group):
            style = STYLES.get(row[-1], "")
            cells = [Text(c, style=style if c == row[-1] else "") for c in row[1:]]
            made.add_row(Text("" if i else quantity, style="bold"), *cells)
        made.add_section()
    return made
