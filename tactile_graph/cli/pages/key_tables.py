"""Tables of all keys that a JSON Schema of a file describes, for people."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

from tactile_graph.pipeline.yaml_numbers import in_yaml as dumped

Schema = dict[str, Any]
NAMES = {"integer": "whole number", "number": "number", "string": "text",
         "boolean": "true or false", "null": "null", "object": "mapping"}  # fmt: skip
SEVERAL = {"section": "sections", "list of sections": "lists of sections"}
SIGNS = {"minimum": "≥", "exclusiveMinimum": ">", "maximum": "≤", "exclusiveMaximum": "<"}


class Key(NamedTuple):
    """One key: what it may hold, what holds without it (empty: nothing), what it means."""

    name: str
    allowed: str
    default: str
    meaning: str


class KeyTable(NamedTuple):
    """The keys of one section: where it stands (empty: at the top), and what it is."""

    place: str
    about: str
    keys: tuple[Key, ...]


def key_tables(schema: Schema) -> list[KeyTable]:
    """Return a table for the top and for each section, in the order in which they are met.

    A section that may stand in several places is told where it is met first.
    """
    top = schema.get("else", schema)
    defs = schema.get("$defs", {})
    found: list[KeyTable] = []
    waiting = [("", top)]
    seen: set[str] = set()
    while waiting:
        place, section = waiting.pop(0)
        found.append(_table(place, section, defs))
        for key, inner in section["properties"].items():
            for name, suffix in _sections(inner):
                if name not in seen:
                    seen.add(name)
                    at = f"{place.partition(' (')[0]}.{key}".removeprefix(".") + suffix
                    waiting.append((at + _kind(defs[name]), defs[name]))
    return found


def _table(place: str, section: Schema, defs: Schema) -> KeyTable:
    required = section.get("required", ())
    keys = tuple(
        Key(name, _allowed(inner, defs), "required" if name in required else _default(inner),
            inner.get("description", ""))
        for name, inner in section["properties"].items()
    )  # fmt: skip
    return KeyTable(place, section.get("description", ""), keys)


def _kind(section: Schema) -> str:
    """Return what tells a section from others in its place: ``" (kind: divider)"``."""
    return "".join(
        f" ({key}: {inner['const']})"
        for key, inner in section["properties"].items()
        if "const" in inner
    )


def _sections(inner: Schema) -> Iterator[tuple[str, str]]:
    """Yield the name of each section that a value may be, and ``"[]"`` for each list it is in."""
    if "$ref" in inner:
        yield str(inner["$ref"]).rpartition("/")[2], ""
    for arm in (*inner.get("anyOf", ()), *inner.get("oneOf", ())):
        yield from _sections(arm)
    if isinstance(inner.get("items"), dict):
        for name, suffix in _sections(inner["items"]):
            yield name, f"[]{suffix}"


def _allowed(inner: Schema, defs: Schema) -> str:
    """Return in words what a value may be."""
    if "$ref" in inner:
        return "section"
    if "const" in inner:
        return in_yaml(inner["const"])
    if "enum" in inner:
        return " or ".join(in_yaml(value) for value in inner["enum"])
    arms = inner.get("anyOf") or inner.get("oneOf")
    if arms:
        return " or ".join(dict.fromkeys(_allowed(arm, defs) for arm in arms))
    if inner.get("type") == "array":
        return _list(inner, defs)
    words = NAMES.get(str(inner.get("type")), "anything")
    ranges = [f"{sign} {inner[name]:g}" for name, sign in SIGNS.items() if name in inner]
    return " ".join([words, ", ".join(ranges)]).strip()


def _list(inner: Schema, defs: Schema) -> str:
    if "prefixItems" in inner:
        return "[" + ", ".join(_allowed(item, defs) for item in inner["prefixItems"]) + "]"
    least = f", {inner['minItems']} or more" if inner.get("minItems") else ""
    held = _allowed(inner.get("items", {}), defs)
    return f"list of {SEVERAL.get(held, held)}{least}"


def _default(inner: Schema) -> str:
    value = inner.get("default")
    return "" if value in (None, "", []) else in_yaml(value)


def in_yaml(value: Any) -> str:
    """Return a plain value as YAML has it in one line."""
    text = dumped(value, default_flow_style=True, width=10_000, allow_unicode=True)
    return text.removesuffix("\n...\n").strip()
