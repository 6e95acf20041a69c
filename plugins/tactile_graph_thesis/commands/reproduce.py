"""``tactile-graph reproduce``: the thesis' tables and figures, ours beside the thesis'."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from tactile_graph_thesis.making import Outcome
    from tactile_graph_thesis.work import Work

BOOK = "book.html"


@click.command()
@click.argument("names", nargs=-1, metavar="[ID…|all]")
@click.option(
    "-o",
    "--output",
    type=click.Path(file_okay=False, path_type=Path),
    default=Path("thesis-book"),
    show_default=True,
    metavar="DIR",
    help="Folder of the files; made if it is not there.",
)
@click.option("--seed", type=click.IntRange(min=0), default=0, show_default=True)
@click.option(
    "--readings",
    type=click.IntRange(min=20),
    metavar="N",
    help="Of each object, for the tables of errors.  [default: 500]",
)
@click.option("--quick", is_flag=True, help="Fewer readings, pads and levels: a first look.")
@click.pass_context
def reproduce(
    ctx: click.Context,
    names: tuple[str, ...],
    output: Path,
    seed: int,
    readings: int | None,
    quick: bool,
) -> None:
    """Make tables and figures of the thesis again; without an ID, list them.

    4.5 is both the table and the figure of that number, table-4.5 only the one; 'all' makes the
    book: one HTML page with everything in it. Figures go into DIR as PNG and SVG, tables as CSV.

    Ours stands beside the thesis' number with the ratio; conclusions of the thesis are checked.
    The exit code is 1 if something could not be made.
    """
    from tactile_graph.compiled import warm_up
    from tactile_graph_thesis.catalogue import chosen
    from tactile_graph_thesis.commands.showing import Showing, list_items, show_end
    from tactile_graph_thesis.making import outcomes
    from tactile_graph_thesis.work import QUICK_READINGS, READINGS, Work

    if not names:
        list_items()
        return
    wanted = chosen(names)
    work = Work(seed, readings or (QUICK_READINGS if quick else READINGS), quick)
    _check(output)
    warm_up()
    start = time.perf_counter()
    found: list[Outcome] = []
    pictures: dict[str, bytes] = {}
    with Showing(wanted, tables="all" not in names) as showing:
        for outcome in outcomes(wanted, work):
            pictures |= _written(outcome, output)
            showing.done(outcome)
            found.append(_without_figure(outcome))
    _write_book(found, pictures, output, work, names)
    show_end(found, output, BOOK if "all" in names else None, time.perf_counter() - start)
    if any(o.made is None for o in found):
        ctx.exit(1)


def _check(output: Path) -> None:
    """Find out before the work whether the folder can be made and written in."""
    from tactile_graph.errors import UsageError
    from tactile_graph.files import check_target

    try:
        output.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise UsageError(f"-o {output}: cannot be made: {error.strerror or error}") from error
    check_target("-o", output / BOOK)


def _written(outcome: Outcome, folder: Path) -> dict[str, bytes]:
    """Write an item's files and return its picture for the book."""
    from tactile_graph_thesis.book.files import files_of, write_all

    if outcome.made is None:
        return {}
    files = files_of(outcome.item.id, outcome.made)
    write_all(folder, files)
    svg = files.get(f"{outcome.item.id}.svg")
    return {} if svg is None else {outcome.item.id: svg}


def _without_figure(outcome: Outcome) -> Outcome:
    """Return the outcome without its figure, which is written and takes much memory."""
    from dataclasses import replace

    if outcome.made is None:
        return outcome
    return replace(outcome, made=replace(outcome.made, figure=None))


def _write_book(
    found: list[Outcome],
    pictures: dict[str, bytes],
    folder: Path,
    work: Work,
    names: tuple[str, ...],
) -> None:
    """Write what is about all items together, where all were asked for."""
    from tactile_graph_thesis.book.files import compared_csv, write_all
    from tactile_graph_thesis.book.page import page

    if "all" in names:
        files = {
            BOOK: page(found, pictures, made_how(work)).encode(),
            "compared.csv": compared_csv(found).encode(),
        }
        write_all(folder, files)


def made_how(work: Work) -> dict[str, str]:
    """Return how a book is made again: the command, and versions of what decides its numbers.

    Parameters
    ----------
    work : Work
    """
    import platform
    from importlib.metadata import version

    from tactile_graph.compiled import have_compiler

    settings = f"--seed {work.seed} --readings {work.readings}" + " --quick" * work.quick
    packages = ["tactile-graph", "numpy", "scipy", "scikit-image", "matplotlib"]
    packages += ["numba"] * have_compiler()
    return {
        "command": f"tactile-graph reproduce all {settings}",
        "pad": "thesis",
        "readings": f"{work.readings} of each object, in groups of {work.group}",
        "versions": ", ".join(
            [f"Python {platform.python_version()}", *(f"{p} {version(p)}" for p in packages)]
        ),
    }
