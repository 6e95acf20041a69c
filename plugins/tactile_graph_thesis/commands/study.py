"""``tactile-graph study``: the studies of thesis chapter 2, with tables and plots."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from tactile_graph_thesis.chapter_2.study import Finding, Study, Table

MOST_ROWS = 24
GAP = 2
"""Blanks between two columns."""
WIDE_STUDIES = ("characteristic", "bump", "foam", "weight-area", "converter")


@click.command()
@click.argument("name", required=False)
@click.option("--pad", "pad_name", default="thesis", show_default=True, help="Name or YAML file.")
@click.option("--seed", type=int, default=0, show_default=True)
@click.option("--plot", type=click.Path(dir_okay=False, path_type=Path),
              help="Draw it (.png, .svg, .pdf).")  # fmt: skip
@click.option("-o", "--output", metavar="FILE.csv",
              help="Write every row as CSV; - or 'csv' for stdout.")  # fmt: skip
def study(
    name: str | None, pad_name: str, seed: int, plot: Path | None, output: str | None
) -> None:
    """Do the study NAME of the thesis' chapter on the pad; without a NAME, list them.

    Shows a table, and what the thesis concludes beside what is found here. The exit code is 1 if
    some conclusion does not come out.
    """
    import numpy as np

    from tactile_graph.files import write_whole
    from tactile_graph_pads.calibration.plot import check_picture
    from tactile_graph_pads.pad import load_pad
    from tactile_graph_thesis.chapter_2 import load_study

    if name is None:
        _list()
        return
    asked = load_study(name)
    if plot is not None:
        check_picture(plot)
    to = _check_output(output)
    result = asked.run(load_pad(pad_name), np.random.default_rng(seed))
    table, findings = asked.table(result), asked.findings(result)
    if to == "-":
        click.echo(csv_text(table), nl=False)
    elif to is not None:
        write_whole(to, csv_text(table))
    _show(asked, table, findings, pad_name, seed, on_stderr=to == "-")
    if plot is not None:
        draw(asked, result, plot)
    for wrote in (to, plot):
        if wrote not in (None, "-"):
            click.echo(f"wrote {wrote}", err=to == "-")
    if not all(f.holds for f in findings):
        click.get_current_context().exit(1)


def _check_output(output: str | None) -> str | None:
    from tactile_graph.errors import UsageError
    from tactile_graph.files import check_target

    if output in (None, "-"):
        return output
    if output == "csv":
        return "-"
    path = Path(str(output))
    if path.suffix.lower() != ".csv":
        raise UsageError(f"-o {output}: its name must end in .csv, or be - for stdout")
    check_target("-o", path)
    return output


def _list() -> None:
    from tactile_graph.cli.terminal import console
    from tactile_graph_thesis.chapter_2 import load_study, study_names

    grid = _grid()
    for name in study_names():
        one = load_study(name)
        grid.add_row(name, one.figure, one.about)
    console().print(grid)


def _grid() -> Any:
    from rich.table import Table as Grid

    return Grid(box=None, show_header=False, pad_edge=False, padding=(0, 2, 0, 0))


def csv_text(table: Table) -> str:
    """Return a table as CSV, numbers to full precision.

    Parameters
    ----------
    table : Table
    """
    import csv
    import io

    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(table.columns)
    writer.writerows(table.rows)
    return text.getvalue()


def draw(asked: Study[Any], result: Any, path: Path) -> None:
    """Write a study's picture.

    Parameters
    ----------
    asked : Study
    result : named tuple
        What its ``run`` returned.
    path : Path
    """
    from tactile_graph_pads.calibration.plot import new_figure, save_figure

    figure = new_figure(*((12.0, 5.0) if asked.name in WIDE_STUDIES else (7.5, 5.0)))
    asked.plot(figure, result)
    save_figure(figure, path)


def _show(
    asked: Study[Any], table: Table, findings: list[Finding], pad: str, seed: int, on_stderr: bool
) -> None:
    from rich.table import Table as Grid
    from rich.text import Text

    from tactile_graph.cli.terminal import console

    say = console(stderr=on_stderr)
    heading = f" ({asked.figure}): {asked.about}; pad {pad}, seed {seed}"
    say.print(Text.assemble((asked.name, "bold"), heading), soft_wrap=True)
    if not on_stderr:
        grid = Grid(box=None, header_style="bold", pad_edge=False, padding=(0, GAP, 0, 0))
        shown = _spread(len(table.rows))
        names = [column.replace("_", " ") for column in table.columns]
        rows = [[_cell(v) for v in table.rows[k]] for k in shown]
        least = [_least(n, cells) for n, cells in zip(names, zip(*rows, strict=True), strict=True)]
        n = _fitting(least, say.width)
        for name, width in zip(names[:n], least, strict=False):
            grid.add_column("\n".join(wrap(name, width)), justify="right", no_wrap=True)
        for row in rows:
            grid.add_row(*row[:n])
        say.print(grid)
        if n < len(names):
            gone = ", ".join(table.columns[n:])
            say.print(f"not shown, for want of width: {gone}; -o FILE.csv gives all", style="dim",
                      soft_wrap=True)  # fmt: skip
        if len(shown) < len(table.rows):
            say.print(f"{len(shown)} of {len(table.rows)} rows; -o FILE.csv gives all", style="dim")
    for finding in findings:
        mark = ("comes out", "green") if finding.holds else ("DOES NOT COME OUT", "bold red")
        say.print(Text.assemble("\n", (finding.thesis, "bold"), ": ", mark), soft_wrap=True)
        say.print(f"  {finding.found}", soft_wrap=True)


def _least(name: str, cells: Sequence[str]) -> int:
    """Return how narrow a column can be: the words of its name fold, numbers must not."""
    return max(map(len, [*name.split(), *cells]))


def _fitting(least: Sequence[int], width: int) -> int:
    """Return how many columns, from the first on, there is room for."""
    ends = accumulate(w + GAP for w in least)
    return max(1, sum(end - GAP <= width for end in ends))


def _spread(n: int) -> list[int]:
    """Return which rows to show: all, or so many spread evenly from first to last."""
    if n <= MOST_ROWS:
        return list(range(n))
    return [round(k * (n - 1) / (MOST_ROWS - 1)) for k in range(MOST_ROWS)]


def _cell(value: Any) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)
