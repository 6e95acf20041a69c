"""What ``reproduce`` shows: the list of items, a progress bar, tables, and the end."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING, Any

from tactile_graph.cli.terminal import console
from tactile_graph_thesis.book.summary import conclusions, table_lines
from tactile_graph_thesis.book.text import number

if TYPE_CHECKING:
    from tactile_graph_thesis.item import Item, Made
    from tactile_graph_thesis.making import Outcome

MOST_ROWS, MOST_COLUMNS = 24, 12
GAP = 2
"""Blanks between two columns."""


def _grid(*heads: str, text: int = 1) -> Any:
    from rich.table import Table

    grid = Table(box=None, pad_edge=False, header_style="bold", show_header=any(heads))
    for k, head in enumerate(heads):
        grid.add_column(head, justify="left" if k < text else "right", overflow="fold")
    return grid


def list_items() -> None:
    """Print every item with its title."""
    from tactile_graph_thesis.catalogue import items

    grid = _grid("", "", text=2)
    for item in items():
        grid.add_row(item.id, item.title)
    console().print(grid)


class Showing:
    """Shows how far the work is, and each item's numbers where they are wanted.

    Parameters
    ----------
    items : sequence of Item
    tables : bool
        Whether to print each item's numbers; those of the whole book are too many.
    """

    def __init__(self, items: Sequence[Item], tables: bool) -> None:
        self._items, self._tables, self._n = items, tables, 0
        self._say = console(stderr=True)
        self._progress: Any = None
        self._task: Any = None

    def __enter__(self) -> Showing:
        if self._say.is_terminal and len(self._items) > 1:
            from rich.progress import (
                BarColumn,
                MofNCompleteColumn,
                Progress,
                TextColumn,
                TimeElapsedColumn,
            )

            self._progress = Progress(
                TextColumn("{task.description}"),
                BarColumn(),
                MofNCompleteColumn(),
                TimeElapsedColumn(),
                console=self._say,
                transient=True,
            )
            self._progress.start()
            self._task = self._progress.add_task("", total=len(self._items))
            self._announce()
        return self

    def __exit__(self, *_: object) -> None:
        if self._progress is not None:
            self._progress.stop()

    def _announce(self) -> None:
        name = self._items[self._n].name if self._n < len(self._items) else "writing"
        self._progress.update(self._task, description=f"{name:<18}", completed=self._n)

    def done(self, outcome: Outcome) -> None:
        """Say that an item is made, or why it could not be.

        Parameters
        ----------
        outcome : Outcome
        """
        self._n += 1
        if self._progress is not None:
            self._announce()
        elif len(self._items) > 1:
            place = f"{self._n:>3}/{len(self._items)}"
            self._say.print(f"{place} {outcome.item.name} {outcome.seconds:.1f} s", style="dim")
        if outcome.made is None:
            self._say.print(f"{outcome.item.name} could not be made: {outcome.error}", style="red")
        elif self._tables:
            show_item(outcome.item, outcome.made)


def show_item(item: Item, made: Made) -> None:
    """Print an item's numbers, conclusions, remarks and reasons.

    Parameters
    ----------
    item : Item
    made : Made
    """
    from rich.text import Text

    say = console()
    say.print(Text.assemble((f"{item.name}  {item.title}", "bold")))
    say.print(item.shows, soft_wrap=True)
    if made.compared:
        grid = _grid("", "unit", "ours", "5 %", "95 %", "thesis", "ratio", text=2)
        for c in made.compared:
            thesis = "–" if c.thesis is None else ("< " if c.limit else "") + f"{c.thesis:g}"
            grid.add_row(
                c.what,
                c.unit,
                number(c.ours),
                number(c.low),
                number(c.high),
                thesis,
                number(c.ratio),
            )
        say.print(grid)
    elif made.table is not None:
        _show_table(say, made)
    for finding in made.findings:
        mark = ("comes out", "green") if finding.holds else ("DOES NOT COME OUT", "bold red")
        say.print(Text.assemble((finding.thesis, "bold"), ": ", mark), soft_wrap=True)
        say.print(f"  {finding.found}", soft_wrap=True)
    for note in (*made.notes, item.why):
        if note:
            say.print(note, style="dim", soft_wrap=True)
    say.print()


def _show_table(say: Any, made: Made) -> None:
    assert made.table is not None
    columns, rows = made.table.columns[:MOST_COLUMNS], made.table.rows
    step = max(1, -(-len(rows) // MOST_ROWS))
    cells = [[number(v) if isinstance(v, float) else str(v) for v in row] for row in rows[::step]]
    heads = [column.replace("_", " ") for column in columns]
    # Words of a heading may stand one below the other, but no number is broken.
    least = [max(map(len, [*head.split(), *(row[k] for row in cells)]))
             for k, head in enumerate(heads)]  # fmt: skip
    room = sum(end - GAP <= say.width for end in accumulate(w + GAP for w in least))
    columns = columns[: max(1, room)]
    folded = ["\n".join(wrap(h, w)) for h, w in zip(heads, least, strict=True)]
    grid = _grid(*folded[: len(columns)], text=0)
    for row in cells:
        grid.add_row(*row[: len(columns)])
    say.print(grid)
    if step > 1 or len(columns) < len(made.table.columns):
        shown = f"{len(rows[::step])} of {len(rows)} rows"
        shown += f" and {len(columns)} of {len(made.table.columns)} columns"
        say.print(f"{shown}; all are in the CSV file", style="dim", soft_wrap=True)


def show_end(found: Sequence[Outcome], folder: Path, book: str | None, seconds: float) -> None:
    """Print the tables beside the thesis' in a line each, and where the files are.

    Parameters
    ----------
    found : sequence of Outcome
    folder : Path
    book : str, optional
        Name of the book's file.
    seconds : float
        How long it took.
    """
    say = console()
    if book is not None:
        lines = table_lines(found)
        if lines:
            grid = _grid("", "", "numbers", "median of ours/thesis", "thesis' in our range", text=2)
            for x in lines:
                within = f"{x.within} of {x.with_range}" if x.with_range else "–"
                grid.add_row(x.name, x.title, str(x.numbers), number(x.median_ratio), within)
            say.print(grid)
        told = conclusions(found)
        holding = sum(f.holds for _, f in told)
        say.print(f"{holding} of {len(told)} conclusions of the thesis come out")
        failed = [o.item.name for o in found if o.made is None]
        if failed:
            say.print(f"could not be made: {', '.join(failed)}", style="red")
    where = folder / book if book else folder
    say.print(f"wrote {where} ({len(found)} items, {seconds:.0f} s)", soft_wrap=True)
