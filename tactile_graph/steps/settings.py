"""Validate a step's settings against its signature, with errors in the house's words."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

from pydantic import ConfigDict, TypeAdapter, ValidationError

from tactile_graph.errors import did_you_mean, one_of, shown
from tactile_graph.steps.signature import Setting, Signature, strip, type_name

Trouble = tuple[tuple[str | int, ...], str]
"""Where in the settings, and what is wrong there."""

_COMPARISONS = {
    "greater_than": ("gt", ">"),
    "greater_than_equal": ("ge", ">="),
    "less_than": ("lt", "<"),
    "less_than_equal": ("le", "<="),
    "multiple_of": ("multiple_of", "a multiple of"),
}


@lru_cache(maxsize=1024)
def _adapter(setting: Setting) -> TypeAdapter[Any]:
    try:
        return TypeAdapter(setting.annotation, config=ConfigDict(arbitrary_types_allowed=True))
    except Exception:
        # A dataclass or model carries its own configuration and takes none from outside.
        return TypeAdapter(setting.annotation)


def adapter(setting: Setting) -> TypeAdapter[Any]:
    """Return pydantic's validator of one setting."""
    try:
        return _adapter(setting)
    except TypeError:  # an unhashable default
        return _adapter.__wrapped__(setting)


def validate_settings(
    signature: Signature, given: dict[str, Any]
) -> tuple[dict[str, Any], list[Trouble]]:
    """Return the settings to call the step with, and what is wrong with those given."""
    values: dict[str, Any] = {}
    troubles: list[Trouble] = []
    known = {s.name: s for s in signature.settings}
    troubles += [((n,), _unknown(signature, n, list(known))) for n in given if n not in known]
    for name, setting in known.items():
        if name in given:
            try:
                values[name] = _one(setting, given[name])
            except ValidationError as error:
                troubles += [(_path(name, e), _words(e, setting)) for e in _shortest(error)]
            except _BadValue as error:
                troubles.append(((name,), str(error)))
            except Exception as error:  # a plugin's own validator may raise anything
                troubles.append(((name,), f"{error or type(error).__name__}"))
        elif setting.required:
            troubles.append(((), f"setting {name!r} is missing ({type_name(setting.annotation)})"))
        else:
            values[name] = setting.default
    return values, troubles


class _BadValue(Exception):  # noqa: N818 -- never leaves this module
    pass


def _one(setting: Setting, value: Any) -> Any:
    if isinstance(value, bool) and not _takes_bool(setting.annotation):
        # pydantic would read "yes" as the number 1
        raise _BadValue(f"must be {_allowed(setting)}, got {shown(value)}")
    return adapter(setting).validate_python(value)


def _takes_bool(annotation: Any) -> bool:
    text = type_name(annotation)
    return any(
        word in text for word in ("bool", "Any", "object", "True", "False", "dict", "Mapping")
    )


def _allowed(setting: Setting) -> str:
    return type_name(strip(setting.annotation)[0])


def _unknown(signature: Signature, name: str, known: list[str]) -> str:
    hint = did_you_mean(name, known) or f"; {signature.name} takes: {one_of(known)}"
    return f"unknown setting {name!r}{hint}"


def _shortest(error: ValidationError) -> list[Any]:
    """Return one trouble per place: a union reports each of its arms."""
    seen: dict[tuple[str | int, ...], Any] = {}
    for e in error.errors(include_url=False):
        place = tuple(p for p in e["loc"] if isinstance(p, int))
        if place not in seen or _rank(e) < _rank(seen[place]):
            seen[place] = e
    return list(seen.values())


def _rank(e: Any) -> int:
    kind = str(e["type"])
    return 0 if kind in _COMPARISONS else 1 if kind in ("literal_error", "value_error") else 2


def _path(name: str, e: Any) -> tuple[str | int, ...]:
    return (name, *(p for p in e["loc"] if isinstance(p, int)))


def _words(e: Any, setting: Setting) -> str:
    kind, context, got = str(e["type"]), e.get("ctx", {}), e["input"]
    if kind in _COMPARISONS:
        key, sign = _COMPARISONS[kind]
        return f"must be {sign} {context[key]}, got {shown(got)}"
    if kind == "literal_error":
        names = [part.strip().strip("'") for part in _allowed(setting).split("|")]
        hint = did_you_mean(got if isinstance(got, str) else shown(got), names)
        return f"must be one of {_allowed(setting)}, got {shown(got)}{hint}"
    if kind == "value_error":
        return f"{context.get('error', e['msg'])}"
    if kind.endswith(("_parsing", "_type", "_from_float")):
        return f"must be {_allowed(setting)}, got {shown(got)}"
    if kind in ("too_short", "too_long"):
        return f"{str(e['msg'])[0].lower()}{str(e['msg'])[1:]}"
    return f"must be {_allowed(setting)}, got {shown(got)} ({e['msg']})"
