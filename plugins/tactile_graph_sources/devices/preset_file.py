"""Read a kit's preset: by name from the installed plugins, or a user's own YAML file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from tactile_graph.errors import (
    Mark,
    PipelineError,
    Problem,
    UsageError,
    did_you_mean,
    one_of,
    shown,
)
from tactile_graph.files import looked_for
from tactile_graph.pipeline.document import MOST_PROBLEMS, Document, read_document, text_of_file
from tactile_graph.plugins.registry import installed
from tactile_graph_sources.devices import preset as records
from tactile_graph_sources.devices.preset import Preset

DEEPEST = 5
LONGEST_KEY = 40


class PresetError(PipelineError):
    """All that is wrong with a preset file, found in one run."""


def load_preset(name_or_path: str) -> Preset:
    """Return a preset by its name, or from a YAML file.

    Raises
    ------
    UsageError
        If neither a preset nor a file of that name exists.
    PresetError
        If the file is not a preset; names every fault with its line.
    """
    return read_preset(_find(name_or_path))


def _find(name_or_path: str) -> Path:
    registry = installed()
    if registry.has("presets", name_or_path):
        return registry.path("presets", name_or_path)
    path = Path(name_or_path)
    if _is_file(path):
        return path
    if path.suffix in (".yaml", ".yml") or "/" in name_or_path:
        raise UsageError(f"preset file {shown(name_or_path)} does not exist")
    raise UsageError(registry.unknown("presets", name_or_path) + "; or give a YAML file")


def read_preset(path: Path) -> Preset:
    """Return the preset in a file; `load_preset` says what is raised."""
    document, data = _merged(path, DEEPEST)
    try:
        return Preset.model_validate(data)
    except ValidationError as error:
        raise PresetError([_problem(document, e) for e in error.errors()[:MOST_PROBLEMS]]) from None


def _merged(path: Path, deepest: int) -> tuple[Document, dict[str, Any]]:
    """Return a file itself, and its data laid over that of the preset it extends."""
    document = _read(path)
    data = dict(document.data)
    base = data.pop("extends", None)
    if base is None:
        return document, data
    if deepest == 0:
        document.problem("'extends' goes round in a circle")
        raise PresetError(document.problems)
    beside = path.parent / str(base)
    _, below = _merged(beside if _is_file(beside) else _find(str(base)), deepest - 1)
    return document, _laid_over(below, data)


def _is_file(path: Path) -> bool:
    try:
        if path.is_file():
            return True
        looked_for(path)
        return False
    except (OSError, ValueError):  # a name that no file can have
        return False


def _laid_over(below: dict[str, Any], above: dict[str, Any]) -> dict[str, Any]:
    out = dict(below)
    for key, value in above.items():
        old = out.get(key)
        both = isinstance(old, dict) and isinstance(value, dict)
        out[key] = _laid_over(old, value) if both else value  # type: ignore[arg-type]
    return out


def _read(path: Path) -> Document:
    """Return a file that holds a mapping; what else is wrong with its YAML is raised."""
    try:
        document = read_document(text_of_file(path), str(path))
    except OSError as error:
        raise UsageError(f"preset {path}: {error.strerror}") from None
    except UnicodeDecodeError:
        raise PresetError([Problem(Mark(str(path), 1, 1), "is not UTF-8 text")]) from None
    if not document.problems and not isinstance(document.data, dict):
        got = type(document.data).__name__
        document.problem(f"must be a mapping with keys {', '.join(Preset.model_fields)}, got {got}")
    if document.problems:
        raise PresetError(document.problems)
    return document


def _problem(document: Document, error: ErrorDetails) -> Problem:
    """Return a validation error in words, at its line."""
    where = [k for k in error["loc"] if not (isinstance(k, str) and k in _TAGS)]
    mark = document.mark(*where, key=error["type"] == "extra_forbidden")
    dotted = ".".join(shown(k) if len(str(k)) > LONGEST_KEY else str(k) for k in where) or "preset"
    return Problem(mark, f"{dotted}: {_words(error, where)}", document.snippet(mark))


_TAGS = {"packet", "text"} | {"magic", "skip", "cells", "crc16"}
_TAGS |= {"sequence", "time", "length", "start", "device", "delimited"}


def _words(error: ErrorDetails, where: list[int | str]) -> str:
    kind, context = error["type"], error.get("ctx", {})
    if kind == "extra_forbidden":
        allowed = _allowed(error["loc"])
        near = did_you_mean(str(where[-1]), allowed)
        return f"unknown key{near or '; allowed: ' + one_of(allowed)}"
    if kind == "missing":
        return "is missing"
    if kind == "union_tag_not_found":
        return f"needs the key {context.get('discriminator')}"
    if kind == "union_tag_invalid":
        tag = str(context.get("tag"))
        tags = [t.strip(" '") for t in str(context.get("expected_tags")).split(",")]
        return f"must be one of {', '.join(tags)}, got {shown(tag)}{did_you_mean(tag, tags)}"
    if kind == "literal_error":
        got, allowed_text = error["input"], str(context.get("expected"))
        tags = [t.strip(" '") for t in allowed_text.replace(" or ", ",").split(",")]
        return f"must be {allowed_text}, got {shown(got)}{did_you_mean(str(got), tags)}"
    if kind == "value_error":
        return error["msg"].removeprefix("Value error, ")
    message = error["msg"]
    return f"{message[0].lower()}{message[1:]}, got {shown(error['input'])}"


def _allowed(loc: tuple[int | str, ...]) -> list[str]:
    """Return the keys allowed where an unknown one stands."""
    by_name: dict[str, type[BaseModel]] = {
        "transport": records.Transport,
        "request": records.Request,
        "geometry": records.Geometry,
        "packet": records.Packet,
        "text": records.Text,
        "delimited": records.Delimited,
        "magic": records.Magic,
        "skip": records.Skip,
        "cells": records.Cells,
        "crc16": records.Checksum,
    }
    by_name |= dict.fromkeys(("sequence", "time", "length", "start", "device"), records.Value)
    parents = [k for k in loc[:-1] if isinstance(k, str) and k in by_name]
    model: type[BaseModel] = by_name[parents[-1]] if parents else Preset
    extra = [] if parents else ["extends"]
    return [*model.model_fields, *extra]
