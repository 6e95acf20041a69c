"""``tactile-graph summary``: what results come to, by recording and in all."""

from __future__ import annotations

import json
from pathlib import Path

import click


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

    found = Summary()
    for path in results:
        prefix = f"{path}: " if len(results) > 1 else ""
        for chunk in chunks(path):
            found.add(chunk, path.name, prefix)
    if as_json:
        hand_over(json.dumps(as_data(found), ensure_ascii=False) + "\n")
        return
    show(console(), ", ".join(map(str, results)), found)
