"""``tactile-graph study``: the studies of thesis chapter 2, with tables and plots."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from tactile_graph_pads.studies.study import Finding, Study, Table

MOST_ROWS = 24
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

    from tactile_graph_pads.calibration_plot import check_picture
    from tactile_graph_pads.pad import load_pad
    from tactile_graph_pads.studies import load_study

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
        Path(to).write_text(csv_text(table), encoding="utf-8")
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

    if output in (None, "-"):
        return output
    if output == "csv":
        return "-"
    path = Path(str(output))
    if path.suffix.lower() != ".csv":
        raise UsageError(f"-o {output}: its name must end in .csv, or be - for stdout")
    if not path.parent.is_dir():
        raise UsageError(f"-o {output}: there is no folder {str(path.parent)!r}")
    return output


def _list() -> None:
    from tactile_graph.cli.terminal import console
    from tactile_graph_pads.studies import load_study, study_names

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
    from tactile_graph_pads.calibration_plot import new_figure

    figure = new_figure(*((12.0, 5.0) if asked.name in WIDE_STUDIES else (7.5, 5.0)))
    asked.plot(figure, result)
    figure.savefig(path)


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
        grid = Grid(box=None, header_style="bold", pad_edge=False)
        for column in table.columns:
            grid.add_column(column, justify="right", overflow="fold")
        shown = _spread(len(table.rows))
        for k in shown:
            grid.add_row(*(_cell(v) for v in table.rows[k]))
        say.print(grid)
        if len(shown) < len(table.rows):
            say.print(f"{len(shown)} of {len(table.rows)} rows; -o FILE.csv gives all", style="dim")
    for finding in findings:
        mark = ("comes out", "green") if finding.holds else ("DOES NOT COME OUT", "bold red")
        say.print(Text.assemble("\n", (finding.thesis, "bold"), ": ", mark), soft_wrap=True)
        say.print(f"  {finding.found}", soft_wrap=True)


def _spread(n: int) -> list[int]:
    """Return which rows to show: all, or so many spread evenly from first to last."""
    if n <= MOST_ROWS:
        return list(range(n))
    return [round(k * (n - 1) / (MOST_ROWS - 1)) for k in range(MOST_ROWS)]


def _cell(value: Any) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)
