"""Read a YAML document into a frozen record, with everything wrong reported by file and line."""

from __future__ import annotations

import math
from collections.abc import Hashable, Mapping, Sequence
from functools import cache
from typing import Any, TypeVar, cast

from pydantic import TypeAdapter, ValidationError

from tactile_graph.errors import PipelineError, Problem, did_you_mean, one_of, shown
from tactile_graph.pipeline.document import Document, Path

T = TypeVar("T")
_COMPARISONS = {
    "greater_than": ("gt", ">"),
    "greater_than_equal": ("ge", ">="),
    "less_than": ("lt", "<"),
    "less_than_equal": ("le", "<="),
}


_MAPS = ("dataclass_type", "model_attributes_type")
"""Pydantic's words for something else where a mapping is due that makes a record."""


class RecordError(PipelineError):
    """All that is wrong with a pad or scene, found in one run."""


def read_record(document: Document, kind: type[T], what: str) -> T:
    """Return the record a document describes.

    Parameters
    ----------
    document : Document
        As read; its own problems are reported too.
    kind : type
        A frozen dataclass that forbids unknown keys. Its ``key_hints`` tell what is meant where a
        key, known or not, is wrong; its ``may_be_infinite`` names the keys for which infinity is
        an answer.
    what : str
        What the file should be, for its errors: ``"a pad"``.

    Raises
    ------
    RecordError
        With every problem of the file.
    """
    if not document.problems and not isinstance(document.data, Mapping):
        document.problem(f"{what} is a mapping of settings, got {shown(document.data)}")
    if document.problems:
        raise RecordError(document.problems)
    try:
        record: T = _adapter(cast(Hashable, kind)).validate_python(document.data)
    except ValidationError as error:
        for e in _one_a_place(document.data, error.errors(include_url=False)):
            _note(document, e, kind)
        raise RecordError(document.problems) from None
    _refuse_no_numbers(document, document.data, record, ())
    if document.problems:
        raise RecordError(document.problems)
    return record


@cache
def _adapter(kind: Hashable) -> TypeAdapter[Any]:
    """Return pydantic's validator of a record, which takes longer to make than to use."""
    return TypeAdapter(cast(Any, kind))


def _refuse_no_numbers(document: Document, data: Any, value: Any, path: Path) -> None:
    """Note each yes or no that was taken as the number 1 or 0, and each number that is none."""
    if isinstance(data, Mapping):
        endless = getattr(value, "may_be_infinite", ())
        for key, inner in data.items():
            if key not in endless:
                _refuse_no_numbers(document, inner, getattr(value, key), (*path, key))
    elif isinstance(data, list | tuple):
        for index, inner in enumerate(data):
            _refuse_no_numbers(document, inner, value[index], (*path, index))
    elif isinstance(data, bool) and not isinstance(value, bool):
        document.problem(f"{path[-1]} must be a number, got {shown(data)}", *path)
    elif isinstance(value, float) and not math.isfinite(value):
        document.problem(f"{path[-1]} must be a finite number, got {shown(data)}", *path)


def inline(data: Mapping[str, Any], where: str) -> Document:
    """Return a document around data that came from no file, so that errors name ``where``."""
    return _Inline(where, "", dict(data))


class _Inline(Document):
    """Says where a value stands by its path: there is no line to point at."""

    def problem(self, message: str, *path: str | int, key: bool = False) -> None:
        place = "".join(f"[{p}]" if isinstance(p, int) else f".{p}" for p in path)
        self.problems.append(Problem(None, f"{self.file}{place}: {message}"))


def _one_a_place(data: Any, errors: Sequence[Any]) -> list[Any]:
    """Join what the arms of a union say about one value, which is wrong only once."""
    joined: dict[Any, Any] = {}
    for e in errors:
        path, rest = _walk(data, e["loc"])
        # what is unknown or missing below a value is a trouble of its own
        key = (path, rest[-1:] if e["type"] in ("missing", "unexpected_keyword_argument") else ())
        if key in joined:
            e = {**joined[key], "msg": f"{joined[key]['msg']} or {e['msg'].removeprefix('Input ')}"}
        joined[key] = e
    return list(joined.values())


def _note(document: Document, e: Any, kind: Any) -> None:
    path, rest = _walk(document.data, e["loc"])
    error, got, context = str(e["type"]), e["input"], e.get("ctx", {})
    name = str(path[-1]) if path else ""
    if error in ("unexpected_keyword_argument", "extra_forbidden"):
        document.problem(_unknown_key(name, e["loc"][:-1], kind), *path, key=True)
    elif error in ("missing", "missing_argument"):
        document.problem(f"{rest[-1]!r} is missing", *path)
    elif error == "union_tag_not_found":
        tag = str(context["discriminator"]).strip("'")
        document.problem(f"{tag!r} is missing, it says which kind this is", *path)
    elif error == "union_tag_invalid":
        tags = [t.strip().strip("'") for t in str(context["expected_tags"]).split(",")]
        tag = str(context["discriminator"]).strip("'")
        got = context["tag"]
        message = f"{tag} must be one of {one_of(tags)}, got {shown(got)}{did_you_mean(got, tags)}"
        document.problem(message, *path, tag)
    elif error in _COMPARISONS:
        key, sign = _COMPARISONS[error]
        document.problem(f"{name} must be {sign} {context[key]:g}, got {shown(got)}", *path)
    elif error == "value_error":
        document.problem(str(context.get("error", e["msg"])), *path)
    elif error in _MAPS:
        allowed = f"; allowed are: {one_of(_keys(_records(kind, path)))}"
        document.problem(f"{name} is a mapping of settings, got {shown(got)}{allowed}", *path)
    else:
        text = str(e["msg"]).removeprefix("Input ")
        hint = _key_hint(name, _records(kind, path[:-1]))
        document.problem(f"{name} {text[0].lower()}{text[1:]}, got {shown(got)}{hint}", *path)


def _walk(data: Any, loc: Path) -> tuple[Path, Path]:
    """Split pydantic's place into keys that are in the data and what is left at the end.

    Pydantic also names the arms of a union, which stand nowhere in the file: those are left out.
    """
    path: list[str | int] = []
    rest: list[str | int] = []
    for part in loc:
        if not _holds(data, part):
            rest.append(part)
            continue
        data, rest = data[part], []
        path.append(part)
    return tuple(path), tuple(rest)


def _holds(data: Any, part: str | int) -> bool:
    if isinstance(data, Mapping):
        return part in data
    return isinstance(data, list | tuple) and isinstance(part, int) and part < len(data)


def _unknown_key(name: str, parents: Path, kind: Any) -> str:
    within = _records(kind, parents)
    known = _keys(within)
    hint = _key_hint(name, within) or did_you_mean(name, known) or f"; allowed are: {one_of(known)}"
    return f"unknown key {shown(name)}{hint}"


def _keys(within: Sequence[Any]) -> list[str]:
    """Return the keys of records."""
    from dataclasses import fields

    return sorted({f.name for k in within for f in fields(k)})


def _key_hint(name: str, within: Sequence[Any]) -> str:
    """Return what one of the records that a key may stand in says of it."""
    hints = [k.key_hints[name] for k in within if name in getattr(k, "key_hints", {})]
    return f"; {hints[0]}" if hints else ""


def _records(kind: Any, parents: Path) -> list[Any]:
    """Return the records that may stand below ``parents``, read off the annotations."""
    from dataclasses import is_dataclass
    from typing import get_args, get_type_hints

    def records(annotation: Any) -> list[Any]:
        if is_dataclass(annotation):
            return [annotation]
        return [r for a in get_args(annotation) for r in records(a)]

    found = [kind]
    for part in parents:
        if isinstance(part, int):
            continue
        inner = [get_type_hints(k).get(part) for k in found]
        deeper = [r for annotation in inner for r in records(annotation)]
        tagged = [k for k in found if part == getattr(k, "kind", getattr(k, "shape", None))]
        found = deeper or tagged or found
    return found
