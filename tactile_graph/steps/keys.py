"""Keys that no field has: refused wherever a type did not say itself what becomes of them."""

from __future__ import annotations

from typing import Any

from pydantic import TypeAdapter
from pydantic_core import SchemaValidator

CHOICE = "extra_fields_behavior"
_KEYED = ("model", "dataclass", "typed-dict")


def refuse_unknown_keys(adapter: TypeAdapter[Any]) -> TypeAdapter[Any]:
    """Have a validator refuse what pydantic drops unless told otherwise: a key misspelt.

    Dataclasses, models and typed dicts at any depth; one that says ``extra`` in its own
    configuration keeps to that.
    """
    schema = _refusing(adapter.core_schema)
    if schema is not adapter.core_schema:
        adapter.core_schema = schema
        adapter.validator = _validator(schema)
    return adapter


def _validator(schema: Any) -> SchemaValidator:
    make: Any = SchemaValidator
    try:
        # Models bring validators of their own, which would stand in for what the schema says.
        made: SchemaValidator = make(schema, _use_prebuilt=False)
    except TypeError:  # of a pydantic that knows no such choice
        made = make(schema)
    return made


def _refusing(part: Any) -> Any:
    """Return a part of pydantic's schema so changed; the same object where nothing is."""
    if isinstance(part, list):
        items = [_refusing(p) for p in part]
        return items if any(new is not old for new, old in zip(items, part, strict=True)) else part
    if not isinstance(part, dict):
        return part
    kind = part.get("type")
    values = "default", "metadata", "config"  # but fields may have such names
    left = values if isinstance(kind, str) else ()
    made = {key: value if key in left else _refusing(value) for key, value in part.items()}
    config = part.get("config") or {}
    if kind in _KEYED and CHOICE not in config and part.get("extra_behavior") in (None, "ignore"):
        made["config"] = {**config, CHOICE: "forbid"}
        made.pop("extra_behavior", None)
    elif all(made[key] is value for key, value in part.items()):
        return part
    return made
