"""Which recordings hold which loads: ``FILE=GRAMS`` on a command line, or a YAML or CSV list."""

from __future__ import annotations

import csv
import io
import math
import re
from pathlib import Path
from typing import NamedTuple

from tactile_graph.errors import DataError, PipelineError, UsageError
from tactile_graph.text_files import decoded
from tactile_graph_pads.pad import read_file


class Loaded(NamedTuple):
    """A recording and the weight that lay on its group; None where the frames' truth says it."""

    path: Path
    load_g: float | None


def parse_loaded(text: str) -> Loaded:
    """Return the recording and load of ``FILE=GRAMS`` or ``FILE``.

    Parameters
    ----------
    text : str

    Raises
    ------
    UsageError
        If what follows ``=`` is no weight above 0.
    """
    path, sign, weight = text.rpartition("=")
    if not sign or Path(text).exists():
        return Loaded(Path(text), None)
    return Loaded(Path(path), _grams(weight, text))


def _grams(value: object, where: str) -> float:
    try:
        grams = float(str(value))
    except ValueError:
        grams = math.nan
    if isinstance(value, bool) or not (math.isfinite(grams) and grams > 0.0):
        raise UsageError(f"{where}: a load is a number of grams above 0, got {value!r}")
    return grams


def read_loads(path: Path) -> list[Loaded]:
    """Return the recordings and loads that a YAML or CSV list names, relative to its folder.

    Parameters
    ----------
    path : Path
        YAML: a mapping of recording to grams, or a list of such mappings where a recording
        stands several times. CSV: columns ``recording`` and ``load_g``, parted by comma,
        semicolon or tab.

    Raises
    ------
    DataError
        If it is neither.
    """
    rows = _csv_rows(path) if path.suffix.lower() == ".csv" else _yaml_rows(path)
    return [Loaded(path.parent / name, _grams(load, where)) for name, load, where in rows]


def _csv_rows(path: Path) -> list[tuple[str, object, str]]:
    try:
        text = decoded(path.read_bytes())
    except UnicodeDecodeError as error:
        line = error.object[: error.start].count(b"\n") + 1
        raise DataError(f"{path}:{line}", "is not UTF-8 text; save it as UTF-8") from None
    with io.StringIO(text, newline="") as file:
        head = file.readline()
        file.seek(0)
        separator = ";" if ";" in head else "\t" if "\t" in head else ","
        table = csv.DictReader(file, delimiter=separator, skipinitialspace=True)
        missing = {"recording", "load_g"} - set(table.fieldnames or ())
        if missing:
            raise DataError(
                f"{path}:1", f"needs the columns recording and load_g, got {table.fieldnames}"
            )
        return [
            (str(row["recording"]).strip(), _decimal(row["load_g"]), f"{path}:{table.line_num}")
            for row in table
        ]


def _decimal(text: str | None) -> str:
    """Return a number with a decimal point; spreadsheets of half the world write a comma.

    ``1,500`` may be of thousands and stays as it is, no number.
    """
    found = re.fullmatch(r"\s*(\d+),(\d+)\s*", text or "")
    return f"{found[1]}.{found[2]}" if found and len(found[2]) != 3 else text or ""


def _yaml_rows(path: Path) -> list[tuple[str, object, str]]:
    document = read_file(path, "list of loads")
    if document.problems:
        raise PipelineError(document.problems)
    parts = document.data if isinstance(document.data, list) else [document.data]
    rows: list[tuple[str, object, str]] = []
    for part in parts:
        if not isinstance(part, dict):
            raise DataError(str(path), f"must map recordings to grams, got {part!r}")
        rows += [(str(name), load, f"{path}, {name}") for name, load in part.items()]
    return rows
