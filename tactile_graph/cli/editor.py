"""What editors need to help with YAML files: a schema for each, a line naming it, settings."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from tactile_graph.errors import UsageError, shown
from tactile_graph.files import write_whole

FOLDER = ".tactile-graph"
"""Holds the schemas, beside the files they are for."""
SETTINGS = Path(".vscode", "settings.json")
SCHEMAS = "yaml.schemas"
"""Key of VS Code's settings: schema -> files."""
_MODELINE = re.compile(
    r"^[ \t]*#[ \t]*yaml-language-server:[ \t]*\$schema=(\S+)[ \t]*(\r?\n|\Z)", re.M
)


def schema_of(file: Path) -> Path:
    """Return where the schema of a file is kept."""
    return file.parent / FOLDER / f"{file.name}.schema.json"


def write_schema(file: Path, schema: dict[str, Any]) -> Path:
    """Write the schema of a file, and return where.

    Raises
    ------
    UsageError
        If it cannot be written.
    """
    path = schema_of(file)
    try:
        path.parent.mkdir(exist_ok=True)
    except OSError as error:
        raise UsageError(f"{path.parent} cannot be made: {error.strerror or error}") from None
    write_whole(path, json.dumps(schema, ensure_ascii=False) + "\n")
    return path


def with_modeline(text: str, file: Path) -> str:
    """Return a file's text with the line that names its schema to language servers of YAML.

    Raises
    ------
    UsageError
        If it has such a line that names a schema of somebody else.
    """
    line = f"# yaml-language-server: $schema=./{FOLDER}/{file.name}.schema.json"
    found = _MODELINE.search(text)
    if found is None:
        mark = "\ufeff" if text.startswith("\ufeff") else ""
        end = "\r\n" if "\r\n" in text else "\n"
        return f"{mark}{line}{end}{text.removeprefix(mark)}"
    if f"{FOLDER}/" not in found[1]:
        number = text.count("\n", 0, found.start()) + 1
        raise UsageError(
            f"{file}:{number}: it names the schema {shown(found[1])} already; take that line out, "
            f"or write instead: {line}"
        )
    return f"{text[: found.start()]}{line}{found[2]}{text[found.end() :]}"


def settings_text(before: str | None, files: Iterable[Path]) -> str:
    """Return VS Code's settings with the schemas of files among them, all others as they were.

    Parameters
    ----------
    before : str, optional
        What the file of settings holds; None where there is none.
    files : iterable of Path
        Relative to the folder whose settings they are.

    Raises
    ------
    UsageError
        If the settings are no plain JSON, as where they hold comments, which would be lost; says
        what to add.
    """
    added = {f"./{schema_of(f).as_posix()}": [f.as_posix()] for f in files}
    mark = "\ufeff" if before and before.startswith("\ufeff") else ""
    plain = (before or "{}").removeprefix(mark)
    try:
        held = json.loads(plain, object_pairs_hook=_each_once)
        if not isinstance(held, dict) or not isinstance(held.get(SCHEMAS, {}), dict):
            raise ValueError(f"no object, or {SCHEMAS!r} in it is none")
    except ValueError as error:
        what = json.dumps({SCHEMAS: added}, indent=2, ensure_ascii=False)
        raise UsageError(
            f"{SETTINGS} is left as it is, since it is no plain JSON (comments?): {error}; "
            f"add to it:\n{what}"
        ) from None
    indent = re.search(r'^([ \t]+)"', before or "", re.M)
    merged = {**held, SCHEMAS: {**held.get(SCHEMAS, {}), **added}}
    text = json.dumps(merged, indent=indent[1] if indent else 4, ensure_ascii=False)
    return f"{mark}{text}\n"


def _each_once(pairs: Sequence[tuple[str, Any]]) -> dict[str, Any]:
    keys = [key for key, _ in pairs]
    twice = [key for key in keys if keys.count(key) > 1]
    if twice:
        raise ValueError(f"{twice[0]!r} stands in it twice")
    return dict(pairs)
