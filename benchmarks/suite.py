"""All benchmarks that set error against time, by one command; and two runs of them compared.

``python benchmarks/suite.py run -o results.json --plots plots`` measures every family: scenes ×
pipelines × pad sizes, the stream of which little needs much, and the fits and hulls, each beside
its peers in the same run (those that are installed: the ``bench`` extra). ``--quick`` takes a
part of the time.
``python benchmarks/suite.py audit`` tells what each guard of ``adaptive`` is worth on that stream.
``python benchmarks/suite.py verdict old.json new.json`` says what changed beyond the noise.
``python benchmarks/suite.py show results.json`` prints a file's tables again.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import click

sys.path.insert(0, str(Path(__file__).parent))
from rich.console import Console
from suite_parts import fits, frames, records, scenes, stream, tables
from suite_parts.verdict import verdicts

from tactile_graph.compiled import warm_up

CONSOLE = Console()
FAMILIES = ("scenes", "stream", "fits")


@click.group()
def main() -> None:
    """Measure, show, compare."""


@main.command()
@click.option("-o", "--output", type=click.Path(path_type=Path), default=Path("results.json"))
@click.option("--plots", type=click.Path(path_type=Path), help="Folder for one plot a family.")
@click.option("--family", type=click.Choice(FAMILIES), multiple=True)
@click.option("--sizes", default="", help="Pad sizes, with commas; 16 to 256 by default.")
@click.option("--quick", is_flag=True, help="Small pads, few frames and rounds.")
@click.option("--seed", default=0, show_default=True)
def run(
    output: Path, plots: Path | None, family: tuple[str, ...], sizes: str, quick: bool, seed: int
) -> None:
    """Measure all families and write a result file."""
    wanted = tuple(int(s) for s in sizes.split(",") if s) or ((16, 32) if quick else scenes.SIZES)
    start = time.perf_counter()
    warm_up()
    found = list(_measured(family or FAMILIES, wanted, quick, seed))
    results = records.results_of(found, seed)
    records.write(results, output)
    tables.print_tables(results, CONSOLE)
    for path in tables.draw(results, plots) if plots else []:
        CONSOLE.print(f"wrote {path}")
    CONSOLE.print(
        f"wrote {output}: {len(found)} measurements in {time.perf_counter() - start:.0f} s"
    )


def _measured(
    families: tuple[str, ...], sizes: tuple[int, ...], quick: bool, seed: int
) -> Iterator[records.Measured]:
    with CONSOLE.status("") as status:
        if "scenes" in families:
            yield from frames.measured(
                sizes, 10 if quick else 40, 5 if quick else 11, seed, status.update
            )
        if "stream" in families:
            yield from stream.measured(
                200 if quick else 1000, 3 if quick else 7, seed, status.update
            )
        if "fits" in families:
            yield from fits.measured(20 if quick else 200, 5 if quick else 11, seed, status.update)


@main.command()
@click.argument("file", type=click.Path(path_type=Path))
@click.option("--plots", type=click.Path(path_type=Path), help="Folder for one plot a family.")
@click.option("--case", help="Only this case, such as 'noisy 16'.")
def show(file: Path, plots: Path | None, case: str | None) -> None:
    """Print a result file's tables."""
    results = _read(file)
    if case is not None:
        only = tuple(m for m in results.measured if m.case == case)
        if not only:
            known = ", ".join(dict.fromkeys(m.case for m in results.measured))
            raise click.ClickException(f"{file} holds no case {case!r}; it holds {known}")
        results = replace(results, measured=only)
    tables.print_tables(results, CONSOLE)
    for path in tables.draw(results, plots) if plots else []:
        CONSOLE.print(f"wrote {path}")


@main.command()
@click.option("--frames", default=400, show_default=True)
@click.option("--seed", default=0, show_default=True)
def audit(frames: int, seed: int) -> None:
    """Tell what each guard of the pipeline ``adaptive`` saves on the stream, and what it costs."""
    from tactile_graph_compare.commands.audit import error_table, worth_table
    from tactile_graph_compare.output.shown import rich_table

    warm_up()
    found = stream.audited(frames, seed)
    CONSOLE.print(f"{found.n_frames} frames; adaptive takes {found.median_us:.1f} us (median)")
    for table in (worth_table(found), error_table(found)):
        CONSOLE.print(rich_table(table))


@main.command()
@click.argument("old", type=click.Path(path_type=Path))
@click.argument("new", type=click.Path(path_type=Path))
@click.option("--all", "everything", is_flag=True, help="Also what did not change.")
def verdict(old: Path, new: Path, everything: bool) -> None:
    """Say what became faster, slower, better or worse; exit 1 if anything got slower or worse."""
    before, after = _read(old), _read(new)
    for name, one, two in (
        ("machine", before.machine, after.machine), ("seed", before.seed, after.seed)
    ):  # fmt: skip
        if one != two:
            CONSOLE.print(f"another {name}: {one} before, {two} now")
    for package in sorted({*before.versions, *after.versions}):
        one, two = before.versions.get(package, "none"), after.versions.get(package, "none")
        if one != two:
            CONSOLE.print(f"{package}: {one} before, {two} now")
    found = verdicts(before, after)
    tables.print_verdicts(found, CONSOLE, everything)
    sys.exit(any(v.word in ("slower", "worse") for v in found))


def _read(path: Path) -> records.Results:
    try:
        return records.read(path)
    except ValueError as error:
        raise click.ClickException(str(error)) from None


if __name__ == "__main__":
    main()
