"""Validate a step's settings against its signature, with errors in the house's words."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from enum import Enum
from functools import lru_cache
from pathlib import Path
from typing import Any, Literal, get_args, get_origin

import numpy as np
from pydantic import ConfigDict, TypeAdapter, ValidationError

from tactile_graph.errors import did_you_mean, key_typo, one_of, shown
from tactile_graph.steps.arrays import is_array, with_arrays
from tactile_graph.steps.inner import (
    Place,
    fields,
    holds,
    is_open,
    item,
    key_of,
    leaves,
    members,
    n_items,
    place,
    written_type,
)
from tactile_graph.steps.keys import refuse_unknown_keys
from tactile_graph.steps.signature import Setting, Signature, type_name

Trouble = tuple[tuple[str | int, ...], str]
"""Where in the settings, and what is wrong there."""

_WORDS = {
    int: "a whole number",
    float: "a number",
    str: "a text",
    bool: "true or false",
    Path: "a path",
    np.ndarray: "a list of numbers",
    type(None): "null",
}
_MEANT = {"int": int, "float": float, "string": str, "bool": bool, "path": Path}
"""What an error is about, by the first word of its name, where no annotation tells."""
_UNKNOWN = ("unexpected_keyword_argument", "extra_forbidden")
_ENDLESS = "finite_number"
_TELLING = (*_UNKNOWN, "literal_error", "value_error")
_QUOTED = re.compile(r"\s*[-+]?(\d+|\d*\.\d+|\d+\.\d*)\s*")
"""Numbers that are a text only where somebody quoted them: YAML reads 5e-1 as one by itself."""
_NAN = re.compile(r"\s*[-+]?nan\s*", re.IGNORECASE)
_WITH_UNIT = re.compile(r"\s*([-+]?\d*[.,]?\d+(?:[eE][-+]?\d+)?)\s*([A-Za-z%°µΩ]*)\s*")
_READ_AS = {True: ("on", "yes", "true"), False: ("off", "no", "false")}
"""Words that YAML reads as something else without quotes."""
LARGEST_EXACT = 2.0**53
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
        made = TypeAdapter(
            with_arrays(setting.annotation), config=ConfigDict(arbitrary_types_allowed=True)
        )
    except Exception:
        # A dataclass or model carries its own configuration and takes none from outside.
        made = TypeAdapter(setting.annotation)
    return refuse_unknown_keys(made)


def adapter(setting: Setting) -> TypeAdapter[Any]:
    """Return pydantic's validator of one setting."""
    try:
        return _adapter(setting)
    except TypeError:  # an unhashable default
        return _adapter.__wrapped__(setting)


def takes_text(signature: Signature, name: str) -> bool:
    """Return whether a setting of that name is there, and may be a text, whichever it be."""
    return str in _kinds_beside_others(signature, name)


def takes_paths(signature: Signature, name: str) -> bool:
    """Return whether a setting of that name is there, and may be a path, whichever it be."""
    return Path in _kinds_beside_others(signature, name)


def _kinds_beside_others(signature: Signature, name: str) -> set[Any]:
    """Return whether a setting may be a text, a path or both, beside what holds several values.

    None of them where a single word may be something else, too, such as a number.
    """
    found = next((members(s.annotation) for s in signature.settings if s.name == name), [])
    kinds = {kind for kind in found if kind is not type(None) and not holds(kind)}
    return kinds if kinds <= {str, Path} else set()


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
            wrong = _mistyped(setting, given[name]) | _not_numbers(setting, given[name])
            try:
                values[name] = adapter(setting).validate_python(given[name])
            except ValidationError as error:
                found = _shortest(error, given[name])
                wrong = {p: _words(e, setting, p) for p, e in found.items()} | wrong
            except Exception as error:  # a plugin's own validator may raise anything
                wrong = wrong or {(): f"{error or type(error).__name__}"}
            troubles += [((name, *p), message) for p, message in wrong.items()]
        elif setting.required:
            troubles.append(((), f"setting {name!r} is missing ({_allowed(setting.annotation)})"))
        else:
            values[name] = setting.default
    return values, troubles


def spelled(path: tuple[str | int, ...]) -> str:
    """Return the names on a trouble's path as people write them: ``model.lambda_d``."""
    return ".".join(p for p in path if isinstance(p, str))


def _mistyped(setting: Setting, value: Any) -> dict[Place, str]:
    """Return what is wrong with each true or false, and each text, that stands for no such thing.

    pydantic would read "yes" as the number 1, and "0.2" as the number 0.2.
    """
    wrong: dict[Place, str] = {}
    for at, annotation, leaf in leaves(setting.annotation, value):
        if isinstance(leaf, bool) and not _takes_bool(annotation):
            told = f"got {shown(leaf)}{_unquoted(leaf, annotation)}"
            wrong[at] = f"must be {_allowed(annotation)}, {told}"
        elif isinstance(leaf, str) and _QUOTED.fullmatch(leaf) and _only_numbers(annotation):
            fits = float in members(annotation) or _whole(leaf)
            hint = "; without the quotes it is a number" if fits else ""
            wrong[at] = f"must be {_allowed(annotation)}, got the text {shown(leaf)}{hint}"
    return wrong


def _not_numbers(setting: Setting, value: Any) -> dict[Place, str]:
    """Return what is wrong with each NaN; infinity may well mean that there is no limit.

    Where a setting is NaN unless given, it may be given, too: a resolved pipeline holds it. So may
    it where anything may stand.
    """
    if _is_nan(value) and _is_nan(setting.default):
        return {}
    nans = [(at, leaf) for at, leaf in _all(value) if _is_nan(leaf)]
    told = [(at, leaf) for at, leaf in nans if not is_open(setting.annotation, at)]
    wrong = {at: f"must be a number, got {leaf}" for at, leaf in told}
    for at, annotation, leaf in leaves(setting.annotation, value):
        if at in wrong and annotation is not Any:
            wrong[at] = f"must be {_allowed(annotation)}, got {leaf}"
        elif isinstance(leaf, str) and _NAN.fullmatch(leaf) and _only_numbers(annotation):
            wrong[at] = f"must be {_allowed(annotation)}, got the text {shown(leaf)}"
    return wrong


def _is_nan(value: Any) -> bool:
    return isinstance(value, float | np.floating) and bool(np.isnan(value))


def _all(value: Any, at: Place = ()) -> Iterator[tuple[Place, Any]]:
    """Yield place and value of all that is given within mappings and lists, known or not."""
    if isinstance(value, Mapping):
        for name, inner in value.items():
            yield from _all(inner, (*at, name))
    elif isinstance(value, list | tuple):
        for i, inner in enumerate(value):
            yield from _all(inner, (*at, i))
    else:
        yield at, value


def _unquoted(got: Any, annotation: Any) -> str:
    """Return which quotes make a text of what YAML read as something else, empty if none do."""
    spelled_so = _READ_AS.get(got, ()) if isinstance(got, bool) else (str(got),)
    texts = [v for v in _choices(annotation) if isinstance(v, str) and v.lower() in spelled_so]
    if texts:
        return f"; put it in quotes: {shown(texts[0])}"
    return "; a text stands in quotes" if str in members(annotation) else ""


def _choices(annotation: Any) -> list[Any]:
    """Return the values of which one must be given."""
    kinds = members(annotation)
    told = [value for kind in kinds if get_origin(kind) is Literal for value in get_args(kind)]
    enums = [kind for kind in kinds if isinstance(kind, type) and issubclass(kind, Enum)]
    return [*told, *(member.value for kind in enums for member in kind)]


def _choice_typo(got: Any, annotation: Any) -> str:
    """Return what was meant by what is none of the choices, empty where nothing is like it."""
    choices = _choices(annotation)
    if isinstance(got, str) and any(str(c) == got and not isinstance(c, str) for c in choices):
        return f"; without the quotes it is one: {got}"
    near = did_you_mean(got if isinstance(got, str) else shown(got), map(str, choices))
    return _unquoted(got, annotation) or near if not isinstance(got, str) else near


def _only_numbers(annotation: Any) -> bool:
    return {*members(annotation)} <= {int, float, type(None)}


def _takes_bool(annotation: Any) -> bool:
    text = type_name(annotation)
    return any(
        word in text for word in ("bool", "Any", "object", "True", "False", "dict", "Mapping")
    )


def _allowed(annotation: Any) -> str:
    """Return what is allowed as people who write YAML say it: ``a number or null``."""
    kinds = members(annotation)
    kinds = [np.ndarray if is_array(kind) else kind for kind in kinds]
    if all(isinstance(kind, type) and kind in _WORDS for kind in kinds):
        return " or ".join(_WORDS[kind] for kind in kinds)
    return written_type(annotation)


def _unknown(signature: Signature, name: str, known: list[str]) -> str:
    hint = key_typo(name, known) or did_you_mean(name, known)
    if not hint and name.isdigit():
        hint = "; the decimals of a number stand behind a point: 0.01"
    return f"unknown setting {name!r}{hint or f'; {signature.name} takes: {one_of(known)}'}"


def _unknown_field(name: str, annotation: Any) -> str:
    known = list(fields(annotation))
    if name in known:  # of one type that may stand there, but not of the one that fits the rest
        return f"setting {name!r} does not go with the others given here"
    hint = did_you_mean(name, known) or f"; {_allowed(annotation)} takes: {one_of(known)}"
    return f"unknown setting {name!r}{hint}"


def _number_typo(got: Any, annotation: Any) -> str:
    """Return what makes a text of what was meant as a number; empty where it was not."""
    found = _WITH_UNIT.fullmatch(got) if isinstance(got, str) else None
    if found is None or not _only_numbers(annotation):
        return ""
    number, unit = found[1].replace(",", "."), found[2]
    if float not in members(annotation):
        number = _whole(number)
    if not number:
        return ""
    if unit:
        return f"; a number stands without its unit: {number}"
    return f"; its decimals stand behind a point: {number}" if "," in got else f"; write {number}"


def _whole(number: str) -> str:
    """Return a number as whole ones are written, empty where it is none or has no end."""
    value = float(number)
    return str(int(value)) if value.is_integer() and abs(value) < LARGEST_EXACT else ""


def _shortest(error: ValidationError, given: Any) -> dict[Place, Any]:
    """Return one trouble per place: a union reports each of its arms."""
    seen: dict[Place, Any] = {}
    absent: dict[tuple[str | int, ...], Any] = {}
    for e in error.errors(include_url=False):
        at = place(given, e["loc"])
        if str(e["type"]).startswith("missing"):
            absent[e["loc"]] = e
        elif at not in seen or _rank(e) < _rank(seen[at]):
            seen[at] = e
    for loc, e in absent.items():
        seen.setdefault(place(given, loc), e)
    return {at: e for at, e in seen.items() if not _of_another_arm(at, e, seen)}


def _of_another_arm(at: Place, e: Any, seen: Mapping[Place, Any]) -> bool:
    """Return whether an arm of a union takes no such thing at all, and one went into it."""
    deeper = any(len(other) > len(at) and other[: len(at)] == at for other in seen)
    return deeper and str(e["type"]).endswith("_type")


def _rank(e: Any) -> int:
    kind = str(e["type"])
    return 0 if kind in _COMPARISONS or kind == _ENDLESS else 1 if kind in _TELLING else 2


def _words(e: Any, setting: Setting, at: Place) -> str:
    kind, context, got = str(e["type"]), e.get("ctx", {}), e["input"]
    annotation, above = setting.annotation, setting.annotation
    for part in at:
        annotation, above = item(annotation, part), annotation
    if kind in _UNKNOWN:
        return _unknown_field(str(at[-1]), above)
    if kind.startswith("missing"):
        wanted = e["loc"][-1]
        if isinstance(got, list | tuple):
            return f"{n_items(annotation)} items needed, got {len(got)}"
        return f"{wanted!r} is missing ({_allowed(item(annotation, wanted))})"
    if e["loc"][-1:] == ("[key]",):
        return f"its key must be {_allowed(key_of(above))}, got {shown(got)}"
    if annotation is Any:
        annotation = _MEANT.get(kind.partition("_")[0], Any)
    if isinstance(got, Mapping) and kind.endswith("_type"):
        got = dict(got)
    if kind in _COMPARISONS:
        key, sign = _COMPARISONS[kind]
        return f"must be {sign} {context[key]}, got {shown(got)}"
    if kind == _ENDLESS:
        return f"must be a finite number, got {shown(got)}"
    if kind in ("literal_error", "enum"):
        told = f"got {shown(got)}{_choice_typo(got, annotation)}"
        return f"must be one of {_allowed(annotation)}, {told}"
    if kind == "value_error":
        told = f"{context.get('error', e['msg'])}"
        return told if re.search(r"\bgot\b", told) else f"{told}, got {shown(got)}"
    if kind.endswith(("_parsing", "_type", "_from_float")) or kind == "is_instance_of":
        return f"must be {_allowed(annotation)}, got {shown(got)}{_number_typo(got, annotation)}"
    if kind in ("too_short", "too_long"):
        if n_items(annotation):
            return f"{n_items(annotation)} items needed, got {context['actual_length']}"
        return f"{str(e['msg'])[0].lower()}{str(e['msg'])[1:]}"
    return f"must be {_allowed(annotation)}, got {shown(got)} ({e['msg']})"
