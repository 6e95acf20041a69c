"""``tactile-graph reproduce``: the thesis' tables, figures and studies, ours beside the thesis'."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tactile_graph.cli.many.options import place_asked, workers_options
from tactile_graph.cli.say import say
from tactile_graph_thesis.commands.targets import BOOK, STDOUT, Targets

if TYPE_CHECKING:
    from tactile_graph_thesis.commands.makers import Makers
    from tactile_graph_thesis.making import Outcome
    from tactile_graph_thesis.work import Work

FOLDER = "thesis-book"


def _complete(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
    """Return the items that begin so, for the shell."""
    from tactile_graph_thesis.catalogue import known

    return [name for name in known() if name.startswith(incomplete)]


@click.command()
@click.argument("names", nargs=-1, metavar="[ID…|all]", shell_complete=_complete)
@click.option(
    "-o",
    "--output",
    type=click.Path(file_okay=False, path_type=Path),
    metavar="DIR",
    help="Folder of the files; made if it is not there.  "
    f"[default: {FOLDER}, if neither --csv, --plot nor --show-only is given]",
)
@click.option("--csv", metavar="FILE.csv", help="The table of one item; - for stdout.")
@click.option(
    "--plot",
    type=click.Path(dir_okay=False, path_type=Path),
    help="The figure of one item (.png, .svg, .pdf).",
)
@click.option("--show-only", is_flag=True, help="Write no files.")
@click.option("--pad", default="thesis", show_default=True, help="Name or YAML file.")
@click.option("--seed", type=click.IntRange(min=0), default=0, show_default=True)
@click.option(
    "--readings",
    type=click.IntRange(min=20),
    metavar="N",
    help="Of each object, for the tables of errors.  [default: 500]",
)
@click.option("--quick", is_flag=True, help="Fewer readings, pads and levels: a first look.")
@workers_options
@click.option("--strict", is_flag=True, help="Exit with 1 also if a conclusion does not come out.")
def reproduce(names: tuple[str, ...], **given: Any) -> None:
    """Make tables, figures and studies of the thesis again; without an ID, list them.

    4.5 is both the table and the figure of that number, table-4.5 only the one; a study has a
    name, such as weight-area; 'all' makes the book: one HTML page with everything in it. Figures
    go into DIR as PNG and SVG, tables as CSV.

    Ours stands beside the thesis' number with the ratio; conclusions of the thesis are checked.
    The exit code is 1 if something could not be made.
    """
    from tactile_graph.compiled import warm_up
    from tactile_graph_thesis.catalogue import chosen
    from tactile_graph_thesis.commands.makers import Makers
    from tactile_graph_thesis.commands.showing import list_items

    if not names:
        list_items()
        return
    items, work, targets = chosen(names), _work(given), _targets(given)
    targets.check(items)
    warm_up()
    place = place_asked(given["workers"], given["on"])
    makers = Makers(items, work, targets, place if len(items) > 1 else None)
    found = _made(makers, book="all" in names)
    failed = any(o.made is None for o in found)
    missed = any(not f.holds for o in found if o.made for f in o.made.findings)
    if failed or (missed and given["strict"]):
        click.get_current_context().exit(1)


def _work(given: dict[str, Any]) -> Work:
    from tactile_graph_pads.pad import load_pad
    from tactile_graph_thesis.work import QUICK_READINGS, READINGS, Work

    load_pad(given["pad"])  # one that is not there is told before the work
    quick = given["quick"]
    readings = given["readings"] or (QUICK_READINGS if quick else READINGS)
    return Work(given["seed"], readings, quick, given["pad"])


def _targets(given: dict[str, Any]) -> Targets:
    from tactile_graph.errors import UsageError

    folder, csv, plot = given["output"], given["csv"], given["plot"]
    named = [o for o, to in (("-o", folder), ("--csv", csv), ("--plot", plot)) if to is not None]
    if given["show_only"] and named:
        raise UsageError(f"--show-only writes no files, but {named[0]} names one")
    if not named and not given["show_only"]:
        folder = Path(FOLDER)
    return Targets(folder, csv, plot)


def _made(makers: Makers, book: bool) -> list[Outcome]:
    """Make, show and write items, and the book where all were asked for."""
    from tactile_graph_thesis.commands.showing import Showing

    start = time.perf_counter()
    found: list[Outcome] = []
    pictures: dict[str, bytes] = {}
    items, work, targets = makers.items, makers.work, makers.targets
    try:
        with Showing(items, work, tables=not book, aside=targets.csv == STDOUT) as showing:
            for written in makers.written():
                if written.svg is not None:
                    pictures[written.outcome.item.id] = written.svg
                showing.done(written.outcome)
                found.append(written.outcome)
    except KeyboardInterrupt:
        if targets.folder is not None:
            say(f"{len(found)} of {len(items)} items are in {targets.folder}", err=True)
        raise
    if book and targets.folder is not None:
        _write_book(found, pictures, targets.folder, work)
    showing.end(found, targets.written(book), time.perf_counter() - start, book)
    return found


def _write_book(found: list[Outcome], pictures: dict[str, bytes], folder: Path, work: Work) -> None:
    """Write what is about all items together."""
    from tactile_graph_thesis.book.files import compared_csv, write_all
    from tactile_graph_thesis.book.page import page
    from tactile_graph_thesis.sections.reading import pipeline_texts

    files = {
        BOOK: page(found, pictures, made_how(work), pipeline_texts()).encode(),
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

    from tactile_graph_thesis.work import PAD

    settings = f"--seed {work.seed} --readings {work.readings}" + " --quick" * work.quick
    settings += f" --pad {work.pad_name}" if work.pad_name != PAD else ""
    packages = ["tactile-graph", "numpy", "scipy", "scikit-image", "matplotlib", "numba"]
    return {
        "command": f"tactile-graph reproduce all {settings}",
        "pad": work.pad_name,
        "readings": f"{work.readings} of each object, in groups of {work.group}",
        "versions": ", ".join(
            [f"Python {platform.python_version()}", *(f"{p} {version(p)}" for p in packages)]
        ),
    }
