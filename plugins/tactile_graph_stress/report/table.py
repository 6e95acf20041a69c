"""The table of a study on the terminal."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from tactile_graph_stress.report.summary import Summary, shown_units, summaries
from tactile_graph_stress.study import Row, worst_first
from tactile_graph_stress.verdict import Outcome

if TYPE_CHECKING:
    from rich.console import RenderableType
    from rich.table import Table
    from rich.text import Text

HEADINGS = {
    Outcome.EXACT: "exact",
    Outcome.GOOD: "good",
    Outcome.DEGRADED: "degr.",
    Outcome.NO_DIGITS: "lost",
    Outcome.FINITE: "finite",
    Outcome.GAVE_UP: "gave up",
    Outcome.BROKEN: "BROKEN",
}
WIDE = 105
"""Columns from which on there is room to say where the largest error was."""


def overview(rows: Sequence[Row], width: int) -> Table:
    """Return a table with one line a step, parted by kind.

    Parameters
    ----------
    rows : sequence of Row
    width : int
        Of the terminal, in columns.
    """
    from rich.table import Table
    from rich.text import Text

    table = Table(box=None, header_style="bold", pad_edge=False, padding=(0, 1, 0, 0))
    table.add_column("step", no_wrap=True)
    for heading in HEADINGS.values():
        table.add_column(heading, justify="right")
    table.add_column("worst", justify="right")
    if width >= WIDE:
        table.add_column("at", no_wrap=True, overflow="ellipsis")
    kind = ""
    for one in summaries(rows):
        if one.kind != kind:
            kind = one.kind
            table.add_row(Text(kind, "dim"))
        table.add_row(*_line(one, width))
    return table


def _line(one: Summary, width: int) -> list[Text | str]:
    from rich.text import Text

    line: list[Text | str] = [f"  {one.step}"]
    for outcome in HEADINGS:
        n = str(one.counts[outcome] or "")
        line.append(Text(n, "bold red") if outcome is Outcome.BROKEN else n)
    worst = one.worst
    line.append("" if worst is None else shown_units(worst.verdict.units or 0.0))
    if width >= WIDE:
        line.append("" if worst is None else f"{worst.group}: {worst.case}")
    return line


def troubles(rows: Sequence[Row]) -> list[RenderableType]:
    """Return a line for each case that broke a step."""
    from rich.text import Text

    broken = [r for r in worst_first(rows) if r.verdict.outcome is Outcome.BROKEN]
    return [
        Text.assemble(
            ("BROKEN ", "bold red"), (r.step, "bold"), f", {r.group}, {r.case}: {r.verdict.note}"
        )
        for r in broken
    ]


LEGEND = (
    "worst: the largest error, in units of eps times the conditioning of the case. exact: up to"
    " 10 units, good: up to 1000, degr.: more; lost: rounding of the input alone decides; finite:"
    " an answer without NaN, nothing to compare it with; gave up: said so in a typed outcome."
)
