"""The files of an item: its table as CSV, its figure as PNG and SVG."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from tactile_graph.files import write_whole
from tactile_graph.foreign_text import csv_line
from tactile_graph_thesis.book.pictures import pictures
from tactile_graph_thesis.item import Made
from tactile_graph_thesis.making import Outcome

COMPARED = ("item", "what", "unit", "ours", "low", "high", "thesis", "ratio")


def csv_text(columns: Sequence[str], rows: Sequence[Sequence[Any]]) -> str:
    """Return a table as CSV, numbers to full precision, nothing for None.

    Parameters
    ----------
    columns : sequence of str
    rows : sequence of sequences
    """
    return "".join(map(csv_line, (columns, *rows)))


def files_of(name: str, made: Made) -> dict[str, bytes]:
    """Return the files of an item, name -> content.

    Parameters
    ----------
    name : str
        The item's id.
    made : Made
    """
    files = {}
    if made.table is not None:
        files[f"{name}.csv"] = csv_text(made.table.columns, made.table.rows).encode()
    if made.figure is not None:
        files |= {f"{name}.{kind}": data for kind, data in pictures(made.figure).items()}
    if made.svg:
        files[f"{name}.svg"] = made.svg.encode()
    return files


def compared_csv(found: Sequence[Outcome]) -> str:
    """Return every number beside the thesis' as one CSV.

    Parameters
    ----------
    found : sequence of Outcome
    """
    rows = [
        (o.item.id, c.what, c.unit, c.ours, c.low, c.high, c.thesis, c.ratio)
        for o in found
        if o.made is not None
        for c in o.made.compared
    ]
    return csv_text(COMPARED, rows)


def write_all(folder: Path, files: dict[str, bytes]) -> list[Path]:
    """Write files into a folder and return their paths.

    Parameters
    ----------
    folder : Path
        Made if it is not there.
    files : dict
        Name -> content.
    """
    folder.mkdir(parents=True, exist_ok=True)
    paths = []
    for name, data in files.items():
        path = folder / name
        write_whole(path, data)
        paths.append(path)
    return paths
