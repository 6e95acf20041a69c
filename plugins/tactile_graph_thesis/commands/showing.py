"""What ``reproduce`` shows: the list of items, a progress bar, tables, and the end."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate
from textwrap import wrap
from typing import TYPE_CHECKING, Any

from tactile_graph.cli.terminal import console
from tactile_graph_thesis.book.summary import NEAR_PERCENT, all_told, conclusions, table_lines
from tactile_graph_thesis.book.text import number

if TYPE_CHECKING:
    from tactile_graph_thesis.item import Item, Made, Table
    from tactile_graph_thesis.making import Outcome
    from tactile_graph_thesis.work import Work

MOST_ROWS = 24
GAP = 2
"""Blanks between two columns."""


def _grid(*heads: str, text: int = 1) -> Any:
    from rich.table import Table

    grid = Table(box=None, pad_edge=False, header_style="bold", show_header=any(heads))
    for k, head in enumerate(heads):
        grid.add_column(head, justify="left" if k < text else "right", overflow="fold")
    return grid


def list_items() -> None:
    """Print every item with the name of its study and its title."""
    from tactile_graph_thesis.catalogue import items

    grid = _grid("", "", "", text=3)
    for item in items():
        grid.add_row(item.id, item.study, item.title)
    console().print(grid)


class Showing:
    """Shows how far the work is, and each item's numbers where they are wanted.

    Parameters
    ----------
    items : sequence of Item
    work : Work
        What they are made with.
    tables : bool
        Whether to print each item's numbers; those of the whole book are too many.
    aside : bool
        Whether stdout is for a table alone: then everything is said on stderr, the table is not.
    """

    def __init__(self, items: Sequence[Item], work: Work, tables: bool, aside: bool) -> None:
        self._items, self._tables, self._aside, self._n = items, tables, aside, 0
        self._how = f"pad {work.pad_name}, seed {work.seed}"
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
            show_item(outcome.item, outcome.made, self._how, self._aside)

    def end(
        self, found: Sequence[Outcome], written: Sequence[str], seconds: float, book: bool
    ) -> None:
        """Say what was written; of a book, also the tables beside the thesis' in a line each.

        Parameters
        ----------
        found : sequence of Outcome
        written : sequence of str
            Names of files and folders.
        seconds : float
            How long it took.
        book : bool
        """
        say = console(stderr=self._aside)
        if book:
            _show_summary(say, found)
        if written:
            n = "1 item" if len(found) == 1 else f"{len(found)} items"
            say.print(f"wrote {', '.join(written)} ({n}, {seconds:.0f} s)", soft_wrap=True)


def show_item(item: Item, made: Made, how: str, aside: bool = False) -> None:
    """Print an item's numbers, conclusions, remarks and reasons.

    Parameters
    ----------
    item : Item
    made : Made
    how : str
        What it was made with.
    aside : bool
        Whether to print on stderr, and no table.
    """
    from rich.text import Text

    say = console(stderr=aside)
    study = f" ({item.study})" if item.study else ""
    heading = Text.assemble((f"{item.name}{study}  {item.title}", "bold"), (f"; {how}", "dim"))
    say.print(heading, soft_wrap=True)
    say.print(item.shows, soft_wrap=True)
    if made.compared:
        say.print(_compared_grid(made))
    elif made.table is not None and not aside:
        _show_table(say, made.table)
    for finding in made.findings:
        mark = ("comes out", "green") if finding.holds else ("DOES NOT COME OUT", "bold red")
        say.print(Text.assemble((finding.thesis, "bold"), ": ", mark), soft_wrap=True)
        say.print(f"  {finding.found}", soft_wrap=True)
        say.print(f"  refuted by: {finding.refuted_by}", style="dim", soft_wrap=True)
    for note in (*made.notes, item.why):
        if note:
            say.print(note, style="dim", soft_wrap=True)
    say.print()


def _compared_grid(made: Made) -> Any:
    grid = _grid("", "unit", "ours", "5 %", "95 %", "thesis", "ratio", text=2)
    for c in made.compared:
        thesis = "–" if c.thesis is None else ("< " if c.limit else "") + f"{c.thesis:g}"
        between = number(c.low), number(c.high)
        grid.add_row(c.what, c.unit, number(c.ours), *between, thesis, number(c.ratio))
    return grid


# -- tables ----------------------------------------------------------------------------------


def _show_table(say: Any, table: Table) -> None:
    """Print as many columns as there is room for, and rows from the first to the last."""
    rows = [[_cell(v) for v in table.rows[k]] for k in _spread(len(table.rows))]
    heads = [column.replace("_", " ") for column in table.columns]
    # Words of a heading may stand one below the other, but no number is broken.
    least = [
        max(map(len, [*head.split(), *cells]))
        for head, cells in zip(heads, zip(*rows, strict=True), strict=True)
    ]
    ends = accumulate(width + GAP for width in least)
    n = max(1, sum(end - GAP <= say.width for end in ends))
    folded = ["\n".join(wrap(h, w)) for h, w in zip(heads[:n], least, strict=False)]
    grid = _grid(*folded, text=0)
    for row in rows:
        grid.add_row(*row[:n])
    say.print(grid)
    if n < len(heads):
        gone = ", ".join(table.columns[n:])
        say.print(f"not shown, for want of width: {gone}", style="dim", soft_wrap=True)
    if n < len(heads) or len(rows) < len(table.rows):
        shown = f"{len(rows)} of {len(table.rows)} rows"
        say.print(f"{shown}; a CSV file has all", style="dim", soft_wrap=True)


def _spread(n: int) -> list[int]:
    """Return which rows to show: all, or so many spread evenly from first to last."""
    if n <= MOST_ROWS:
        return list(range(n))
    return [round(k * (n - 1) / (MOST_ROWS - 1)) for k in range(MOST_ROWS)]


def _cell(value: Any) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)


# -- the book --------------------------------------------------------------------------------


def _show_summary(say: Any, found: Sequence[Outcome]) -> None:
    lines = table_lines(found)
    if lines:
        near = f"within {', '.join(map(str, NEAR_PERCENT))} %"
        heads = (f"averages {near}", f"maxima {near}", "thesis' in our range")
        grid = _grid("", "", *heads, text=2)
        for x in lines:
            within = f"{x.within} of {x.with_range}" if x.with_range else "–"
            grid.add_row(x.name, x.title, str(x.averages), str(x.maxima), within)
        grid.add_row("", "together", *map(str, all_told(lines)), "")
        say.print(grid)
    told = conclusions(found)
    holding = sum(f.holds for _, f in told)
    say.print(f"{holding} of {len(told)} conclusions of the thesis come out")
    failed = [o.item.name for o in found if o.made is None]
    if failed:
        say.print(f"could not be made: {', '.join(failed)}", style="red")
