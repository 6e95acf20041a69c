"""``tactile-graph summary``: what results come to, by recording and in all."""

from __future__ import annotations

import json
from pathlib import Path

import click

from tactile_graph.errors import UsageError


@click.command()
@click.argument("results", nargs=-1, required=True, type=click.Path(path_type=Path))
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object, for programs.")
def summary(results: tuple[Path, ...], as_json: bool) -> None:
    """Say what RESULT… come to: files and data sets that 'run -o' wrote.

    Of each recording and of all: frames, outcomes with the reasons of those that were skipped or
    failed, mean, median and percentiles of each quantity with its unit, errors where the truth was
    known, times. CSV, JSON lines, Parquet; read a chunk at a time, so that files of any size take
    little memory.
    """
    from tactile_graph.cli.say import hand_over
    from tactile_graph.cli.summary.as_data import as_data
    from tactile_graph.cli.summary.reading import chunks
    from tactile_graph.cli.summary.shown import show
    from tactile_graph.cli.summary.summary import Summary
    from tactile_graph.cli.terminal import console

    _refuse_twice(results)
    found = Summary()
    for path in results:
        prefix = f"{path}: " if len(results) > 1 else ""
        for chunk in chunks(path):
            found.add(chunk, path.name, prefix)
    found.end()
    if as_json:
        hand_over(json.dumps(as_data(found), ensure_ascii=False) + "\n")
        return
    show(console(), ", ".join(map(str, results)), found)


def _refuse_twice(results: tuple[Path, ...]) -> None:
    """Refuse a file that is given twice: its frames would count double."""
    given: dict[Path, Path] = {}
    for path in results:
        before = given.setdefault(path.resolve(), path)
        if before is not path:
            also = "" if str(before) == str(path) else f" (also as {before})"
            raise UsageError(f"{path} is given twice{also}: its frames would count double")
