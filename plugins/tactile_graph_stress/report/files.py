"""A study written to a file, in the form its name asks for."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from tactile_graph.files import check_target, write_whole
from tactile_graph.foreign_text import csv_line, visible
from tactile_graph_stress.report.markdown import markdown
from tactile_graph_stress.study import Row

ENDINGS = (".md", ".csv", ".json")
COLUMNS = ("step", "kind", "plugin", "group", "case", "outcome", "units", "condition", "note")


def check_ending(path: Path) -> None:
    """Refuse a file whose name says no known form, or whose folder is not there.

    Raises
    ------
    UsageError
    """
    check_target("-o", path, ENDINGS, told_by_name=True)


def write(path: Path, rows: Sequence[Row], command: str) -> None:
    """Write the rows; ``command`` is what made them."""
    make = {".md": markdown, ".csv": _csv, ".json": _json}[path.suffix.lower()]
    write_whole(path, visible(make(rows, command)))


def _fields(row: Row) -> list[object]:
    v = row.verdict
    of_row: list[object] = [row.step, row.kind, row.plugin, row.group, row.case]
    return [*of_row, v.outcome.value, v.units, v.condition, v.note]


def _csv(rows: Sequence[Row], command: str) -> str:
    return "".join(map(csv_line, (COLUMNS, *map(_fields, rows))))


def _json(rows: Sequence[Row], command: str) -> str:
    import json

    cases = [dict(zip(COLUMNS, _fields(row), strict=True)) for row in rows]
    return json.dumps({"command": command, "cases": cases}, indent=1) + "\n"
