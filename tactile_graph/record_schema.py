"""JSON Schema (draft 2020-12) of a kind of file that holds one record: a pad, a preset, a scene.

What each key means is taken from the docstrings of the records, so that editors, pages and readers
of the code are told the same.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from typing import Any, get_args, get_type_hints

from pydantic import BaseModel, TypeAdapter
from pydantic.json_schema import GenerateJsonSchema

from tactile_graph.docstring import parameters, sections
from tactile_graph.plugins.file_kind import FileKind

DRAFT = "https://json-schema.org/draft/2020-12/schema"
DEFS = "#/$defs/"
PARTIAL = ".partial"
"""Ends the names of definitions that ask for no key, as files laid over others need."""

Schema = dict[str, Any]


def record_schema(kind: FileKind, name: str) -> Schema:
    """Return the schema of files of a kind; every key has its ``description``.

    Parameters
    ----------
    kind : FileKind
    name : str
        What such a file is called: ``"pad"``.
    """
    made = TypeAdapter(kind.record).json_schema(schema_generator=_Untitled)
    defs = made.pop("$defs", {})
    records = {r.__name__: r for r in records_in(kind.record)}
    for record_name, inner in (*defs.items(), (kind.record.__name__, made)):
        if record_name in records:
            _describe(inner, records[record_name], records)
    head = {"$schema": DRAFT, "title": f"tactile-graph {name}"}
    if not kind.base_key:
        return {**head, **made, "$defs": defs}
    made["properties"][kind.base_key] = {
        "type": "string",
        "description": f"Another {name}, by name or file, that this one is laid over: what that "
        "one says need not be said again.",
    }
    partial = {f"{n}{PARTIAL}": _partial(inner) for n, inner in defs.items()}
    return {
        **head, "type": "object",
        "if": {"required": [kind.base_key]}, "then": _partial(made), "else": made,
        "$defs": {**defs, **partial},
    }  # fmt: skip


def records_in(annotation: Any) -> Iterator[type]:
    """Yield every dataclass or model an annotation leads to, each once."""
    seen: set[type] = set()

    def visit(annotation: Any) -> Iterator[type]:
        if not _is_record(annotation):
            for inner in get_args(annotation):
                yield from visit(inner)
        elif annotation not in seen:
            seen.add(annotation)
            yield annotation
            for inner in get_type_hints(annotation).values():
                yield from visit(inner)

    return visit(annotation)


def _is_record(annotation: Any) -> bool:
    model = isinstance(annotation, type) and issubclass(annotation, BaseModel)
    return model or hasattr(annotation, "__dataclass_fields__")


class _Untitled(GenerateJsonSchema):
    """Leaves out titles: they only repeat the keys."""

    def field_title_should_be_set(self, schema: Any) -> bool:
        return False


def _describe(made: Schema, record: type, records: dict[str, type]) -> None:
    """Say of a record and of each of its keys what the docstrings say."""
    made.pop("title", None)
    made["description"] = _summary(record)
    meanings: dict[str, str] = {}
    for base in reversed(record.__mro__):
        meanings |= parameters(inspect.cleandoc(base.__doc__ or ""))
    for key, inner in made["properties"].items():
        if "const" in inner:  # tells the arms of a choice apart, so it has to be there
            inner.pop("default", None)
            made["required"] = list(dict.fromkeys([*made.get("required", ()), key]))
        words = meanings.get(key) or _of_its_record(inner, records)
        inner["description"] = _plain(words)


def _of_its_record(inner: Schema, records: dict[str, type]) -> str:
    """Return what the record that a key holds says of itself."""
    if "const" in inner:
        return "Says which kind this is."
    arms = [inner, *inner.get("anyOf", ())]
    named = [str(arm["$ref"]).removeprefix(DEFS) for arm in arms if "$ref" in arm]
    return _summary(records[named[0]]) if named else ""


def _summary(record: type) -> str:
    paragraph = sections(inspect.cleandoc(record.__doc__ or ""))[""].partition("\n\n")[0]
    return _plain(" ".join(paragraph.split()))


def _plain(text: str) -> str:
    """Return a docstring's words as they are right beside YAML."""
    return re.sub(r"\bNone\b", "null", text.replace("``", "`"))


def _partial(made: Any) -> Any:
    """Return a schema that asks for no key; which arm of a choice is meant may then be open."""
    if isinstance(made, list):
        return [_partial(inner) for inner in made]
    if not isinstance(made, dict):
        return made
    kept = {k: v for k, v in made.items() if k not in ("required", "discriminator")}
    out = {"anyOf" if k == "oneOf" else k: _partial(v) for k, v in kept.items()}
    if isinstance(out.get("$ref"), str):
        out["$ref"] += PARTIAL
    return out
