"""Read a kit's preset: by name from the installed plugins, or a user's own YAML file."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import yaml
from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from tactile_graph.errors import Mark, PipelineError, Problem, UsageError, did_you_mean, one_of
from tactile_graph.pipeline.document import Document
from tactile_graph.plugins.registry import installed
from tactile_graph_sources.devices import preset as records
from tactile_graph_sources.devices.preset import Preset

DEEPEST = 5


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
    if path.is_file():
        return path
    if path.suffix in (".yaml", ".yml") or "/" in name_or_path:
        raise UsageError(f"preset file {name_or_path!r} does not exist")
    raise UsageError(registry.unknown("presets", name_or_path) + "; or give a YAML file")


def read_preset(path: Path) -> Preset:
    """Return the preset in a file; `load_preset` says what is raised."""
    file, data = _merged(path, DEEPEST)
    try:
        return Preset.model_validate(data)
    except ValidationError as error:
        raise PresetError([_problem(file, e) for e in error.errors()]) from None


class _File(NamedTuple):
    """A file that was parsed, to say where in it something is wrong."""

    document: Document
    root: yaml.Node

    def problem(self, node: yaml.Node, message: str) -> Problem:
        mark = Mark(self.document.file, node.start_mark.line + 1, node.start_mark.column + 1)
        return Problem(mark, message, self.document.snippet(mark))


def _merged(path: Path, deepest: int) -> tuple[_File, dict[str, Any]]:
    """Return a file itself, and its data laid over that of the preset it extends."""
    file, data = _parse(path)
    base = data.pop("extends", None)
    if base is None:
        return file, data
    if deepest == 0:
        raise PresetError([file.problem(file.root, "'extends' goes round in a circle")])
    beside = path.parent / str(base)
    _, below = _merged(beside if beside.is_file() else _find(str(base)), deepest - 1)
    return file, _laid_over(below, data)


def _laid_over(below: dict[str, Any], above: dict[str, Any]) -> dict[str, Any]:
    out = dict(below)
    for key, value in above.items():
        old = out.get(key)
        both = isinstance(old, dict) and isinstance(value, dict)
        out[key] = _laid_over(old, value) if both else value  # type: ignore[arg-type]
    return out


def _parse(path: Path) -> tuple[_File, dict[str, Any]]:
    try:
        text = path.read_text(encoding="utf-8")
        node = yaml.compose(text, Loader=yaml.SafeLoader)
        data = yaml.safe_load(text)
    except OSError as error:
        raise UsageError(f"preset {path}: {error.strerror}") from None
    except UnicodeDecodeError:
        raise PresetError([Problem(Mark(str(path), 1, 1), "is not UTF-8 text")]) from None
    except yaml.MarkedYAMLError as error:
        at = error.problem_mark
        mark = Mark(str(path), at.line + 1, at.column + 1) if at else Mark(str(path), 1, 1)
        snippet = Document(str(path), text).snippet(mark)
        raise PresetError([Problem(mark, f"not YAML: {error.problem}", snippet)]) from None
    if node is None or not isinstance(data, dict):
        got = type(data).__name__
        what = f"must be a mapping with keys {', '.join(Preset.model_fields)}, got {got}"
        raise PresetError([Problem(Mark(str(path), 1, 1), what)])
    file = _File(Document(str(path), text), node)
    doubled = list(_doubled(file, node))
    if doubled:
        raise PresetError(doubled)
    return file, data


def _doubled(file: _File, node: yaml.Node) -> list[Problem]:
    """Return a problem for every key given twice, which YAML itself would let pass."""
    out: list[Problem] = []
    if isinstance(node, yaml.MappingNode):
        seen: set[str] = set()
        for key, value in node.value:
            if key.value in seen:
                out.append(file.problem(key, f"key {key.value!r} is given twice"))
            seen.add(key.value)
            out += _doubled(file, value)
    elif isinstance(node, yaml.SequenceNode):
        for item in node.value:
            out += _doubled(file, item)
    return out


def _problem(file: _File, error: ErrorDetails) -> Problem:
    """Return a validation error in words, at its line."""
    where = [k for k in error["loc"] if not (isinstance(k, str) and k in _TAGS)]
    node, key_node = file.root, file.root
    for key in where:
        found = _step(node, key)
        if found is None:
            break
        key_node, node = found
    unknown = error["type"] == "extra_forbidden"
    dotted = ".".join(str(k) for k in where) or "preset"
    return file.problem(key_node if unknown else node, f"{dotted}: {_words(error, where)}")


_TAGS = {"packet", "text"} | {"magic", "skip", "cells", "crc16"}
_TAGS |= {"sequence", "time", "length", "start", "device", "delimited"}


def _step(node: yaml.Node, key: int | str) -> tuple[yaml.Node, yaml.Node] | None:
    if isinstance(node, yaml.MappingNode):
        return next(((k, v) for k, v in node.value if k.value == str(key)), None)
    if isinstance(node, yaml.SequenceNode) and isinstance(key, int) and key < len(node.value):
        return node.value[key], node.value[key]
    return None


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
        return f"must be one of {', '.join(tags)}, got {tag!r}{did_you_mean(tag, tags)}"
    if kind == "literal_error":
        got, allowed_text = error["input"], str(context.get("expected"))
        tags = [t.strip(" '") for t in allowed_text.replace(" or ", ",").split(",")]
        return f"must be {allowed_text}, got {got!r}{did_you_mean(str(got), tags)}"
    if kind == "value_error":
        return error["msg"].removeprefix("Value error, ")
    message = error["msg"]
    return f"{message[0].lower()}{message[1:]}, got {error['input']!r}"


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
