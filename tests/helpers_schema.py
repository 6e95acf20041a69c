"""What an editor would say at a place of a file, by a JSON Schema: completions and hover texts."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import jsonschema

Schema = dict[str, Any]


def applying(schema: Schema, data: Any, path: tuple[str | int, ...]) -> list[Schema]:
    """Return every subschema that applies at a place, as language servers gather them.

    Of ``anyOf`` and ``oneOf`` all arms are taken, of ``if`` the branch that the data choose.
    """
    at = [(schema, data)]
    for key in path:
        at = [
            (inner, there[key])
            for part, there in _unfolded(schema, at)
            for inner in _below(part, there, key)
        ]
    return [part for part, _ in _unfolded(schema, at)]


def _unfolded(root: Schema, waiting: list[tuple[Schema, Any]]) -> Iterator[tuple[Schema, Any]]:
    for part, data in waiting:
        if not isinstance(part, dict):
            continue
        yield part, data
        inner = [*part.get("allOf", ()), *part.get("anyOf", ()), *part.get("oneOf", ())]
        if "$ref" in part:
            inner.append(root["$defs"][part["$ref"].removeprefix("#/$defs/")])
        if "if" in part:
            holds = jsonschema.Draft202012Validator({**part["if"], "$defs": root["$defs"]})
            inner.append(part.get("then" if holds.is_valid(data) else "else", {}))
        yield from _unfolded(root, [(one, data) for one in inner])


def _below(part: Schema, data: Any, key: str | int) -> Iterator[Schema]:
    if isinstance(data, list):
        if "items" in part:
            yield part["items"]
    elif key in part.get("properties", {}):
        yield part["properties"][key]
    elif isinstance(part.get("additionalProperties"), dict):
        yield part["additionalProperties"]


def offered(schema: Schema, data: Any, *path: str | int) -> list[Any]:
    """Return the values that an editor offers at a place."""
    return [value for part in applying(schema, data, path) for value in part.get("enum", ())]


def keys_offered(schema: Schema, data: Any, *path: str | int) -> list[str]:
    """Return the keys that an editor offers in the mapping at a place."""
    return [key for part in applying(schema, data, path) for key in part.get("properties", {})]


def hover(schema: Schema, data: Any, *path: str | int) -> str:
    """Return what an editor shows of a value: the first description that applies."""
    found = (part.get("description", "") for part in applying(schema, data, path))
    return next(filter(None, found), "")
