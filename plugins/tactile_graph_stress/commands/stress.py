"""``tactile-graph stress``: what the steps' numbers withstand, and where they give up."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

import click

from tactile_graph.cli.say import say

if TYPE_CHECKING:
    from rich.console import Console

    from tactile_graph.plugins.registry import Registry
    from tactile_graph_stress.study import Row
    from tactile_graph_stress.subject import Left, Subject


@click.command()
@click.argument("names", nargs=-1, metavar="[STEP | KIND | PLUGIN]...")
@click.option("--quick/--full", default=True, show_default=True,
              help="A few cases of each group, or all.")  # fmt: skip
@click.option("--seed", type=int, default=0, show_default=True, help="Of all that is drawn.")
@click.option("-o", "--output", type=click.Path(dir_okay=False, path_type=Path), metavar="FILE",
              help="Write every case: .md (a report), .csv or .json.")  # fmt: skip
def stress(names: tuple[str, ...], quick: bool, seed: int, output: Path | None) -> None:
    """Try how steps bear hard input, and how exact their answers are.

    Every installed step that can be fed with points, a mask or an image is tried, a third party's
    too: scaled, far away, turned, shuffled, on a line, on short arcs, subnormal, huge, NaN, empty.
    Name steps, plugins or kinds (circle, ellipse, rectangle, hull, orientation, points, mask,
    decouple, restore, image) to try only these. Errors are told in units of rounding times
    the conditioning of the case, against answers of 50 digits where there are such. The exit code
    is 1 if something broke: NaN or infinity came out, a warning or an untyped error escaped, the
    input was written into, or an answer was wrong or another one the second time.
    """
    from tactile_graph.cli.interrupt import code_of, words_of
    from tactile_graph.cli.terminal import console
    from tactile_graph.errors import UsageError
    from tactile_graph.plugins.registry import installed
    from tactile_graph_stress.report.files import check_ending, write
    from tactile_graph_stress.subject import chosen, subjects

    if find_spec("mpmath") is None:
        raise UsageError('stress needs mpmath: pip install "tactile-graph[stress]"')
    if seed < 0:
        raise UsageError(f"--seed must be >= 0, got {seed}")
    if output is not None:
        check_ending(output)
    registry = installed()
    found, apart = subjects(registry)
    wanted, left = chosen(found, _of_packages(names, registry), apart)
    rows, n, ended = _rows(wanted, left, seed, quick, console(stderr=True))
    if left and not rows and ended is None:
        raise UsageError("\n".join(dict.fromkeys(map(str, left))))
    _show(rows)
    _tell_left(left, names)
    if output is not None:
        options = "" if quick else " --full"
        options += f" --seed {seed}" if seed else ""
        write(output, rows, " ".join(["tactile-graph stress", *names]) + options)
        say(f"wrote {output}")
    if ended is not None:
        say(f"{words_of(ended)}: {n} of {len(wanted)} steps", err=True)
        click.get_current_context().exit(code_of(ended))
    if any(r.verdict.outcome.name == "BROKEN" for r in rows):
        click.get_current_context().exit(1)


def _of_packages(names: tuple[str, ...], registry: Registry) -> tuple[str, ...]:
    """Return the names, those of packages as those of their plugins that have steps."""
    held: dict[str, list[str]] = {}
    for plugin in registry.plugins:
        if plugin.offers.get("steps"):
            held.setdefault(plugin.package, []).append(plugin.name)
    return tuple(one for name in names for one in held.get(name, [name]))


def _rows(
    wanted: list[Subject], left: list[Left], seed: int, quick: bool, say: Console
) -> tuple[list[Row], int, KeyboardInterrupt | None]:
    """Return the rows of the steps that were done, of how many, and what ended them early.

    Those that turn out not to be stressed are added to ``left``.
    """
    from tactile_graph_stress.study import NotStressed, stressed
    from tactile_graph_stress.subject import Left

    rows: list[Row] = []
    k = 0
    try:
        with _bar(say, len(wanted)) as at:
            for k, subject in enumerate(wanted):
                at(k, subject.label)
                try:
                    rows += list(stressed(subject, seed, quick))
                except NotStressed as why:
                    left.append(Left(subject.name, subject.plugin, str(why)))
    except KeyboardInterrupt as error:
        return rows, k, error
    return rows, len(wanted), None


@contextmanager
def _bar(say: Console, total: int) -> Iterator[Callable[[int, str], None]]:
    """Show how many steps are done and which one is tried; on a terminal only."""
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

    columns = (
        TextColumn("stress"),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("{task.fields[step]}"),
    )
    with Progress(*columns, console=say, transient=True, disable=not say.is_terminal) as progress:
        task = progress.add_task("stress", total=total, step="")
        yield lambda k, step: progress.update(task, completed=k, step=step)


def _show(rows: list[Row]) -> None:
    from tactile_graph.cli.terminal import console
    from tactile_graph_stress.report.table import LEGEND, overview, troubles

    say = console()
    say.print(overview(rows, say.width))
    for line in troubles(rows):
        say.print(line, soft_wrap=True)
    say.print(LEGEND, style="dim")


def _tell_left(left: list[Left], names: tuple[str, ...]) -> None:
    """Say of named steps why they are not stressed, and of others how many are not."""
    why = {one.name: str(one) for one in left}
    for name in dict.fromkeys(names):
        if name in why:
            say(why.pop(name), err=True)
    if why:
        count = "1 step is" if len(why) == 1 else f"{len(why)} steps are"
        by = f"tactile-graph stress {next(iter(why))}"
        say(f"{count} not stressed; name one to read why: {by}", err=True)
