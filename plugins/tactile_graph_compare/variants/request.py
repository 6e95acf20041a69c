"""What somebody wants compared: a pipeline, what is set of it, what is asked of it."""

from __future__ import annotations

import os
import re
import shlex
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tactile_graph import Pipeline
from tactile_graph.errors import UsageError
from tactile_graph.foreign_text import pasted
from tactile_graph.inspect import plain
from tactile_graph.pipeline.document import assignment, text_of_file
from tactile_graph.plugins.registry import Registry, installed


@dataclass(frozen=True)
class VariantRequest:
    """One variant as it was asked for.

    Parameters
    ----------
    name : str, Path or Pipeline
        A pipeline's name, file, or itself.
    settings : mapping
        ``node.setting`` -> value, instead of the file's.
    only : tuple of str
        Nodes to ask for instead of its outputs.
    swept : bool
        Whether sweeps apply to it; not to parents that were only pulled in.
    """

    name: str | Path | Pipeline
    settings: Mapping[str, Any] = field(default_factory=dict)
    only: tuple[str, ...] = ()
    swept: bool = True


def parse_request(text: str, registry: Registry) -> VariantRequest:
    """Return the variant that ``NAME --set node.setting=value … --only NODE …`` spells.

    Raises
    ------
    UsageError
        If it holds anything else.
    """
    if " " not in text.strip() or registry.has("pipelines", text):
        return VariantRequest(text)
    try:
        name, *rest = words_of(text)
    except ValueError as error:
        raise UsageError(f"variant {text!r}: {error}") from None
    settings: dict[str, Any] = {}
    only: list[str] = []
    waiting = list(rest)
    while waiting:
        option, sign, value = waiting.pop(0).partition("=")
        if option not in ("--set", "--only"):
            raise UsageError(
                f"variant {text!r}: {option!r} is not allowed; it is "
                "'NAME --set node.setting=value … --only NODE …'"
            )
        if not sign:
            if not waiting:
                raise UsageError(f"variant {text!r}: {option} says nothing")
            value = waiting.pop(0)
        if option == "--only":
            only.append(value)
        else:
            settings |= dict([assignment("--set", value)])
    return VariantRequest(name, settings, tuple(only))


def words_of(text: str) -> list[str]:
    """Return a variant's words, the pipeline's name or file first.

    A file's spaces need no quotes, unless two dashes follow: there the options begin. Quotes are
    taken away as in a shell; on Windows a backslash is a letter as any.

    Raises
    ------
    ValueError
        If a quotation does not end.
    """
    found = re.match(r"(?P<file>(?:(?!\s--).)+?\.ya?ml)(?P<rest>\s+--.*)?$", text, re.DOTALL)
    if found is None or found["file"][0] in "\"'":
        return _split(text)
    return [found["file"], *_split(found["rest"] or "")]


def _split(text: str) -> list[str]:
    words = shlex.shlex(text, posix=True, punctuation_chars=False)
    words.whitespace_split = True
    words.commenters = ""
    if os.name == "nt":
        words.escape = ""
    return list(words)


def name_of(pipeline: Pipeline) -> str:
    """Return the name or file that a command knows a pipeline by; "" for one of a program's own.

    That is one made of a text, or with a registry or steps that no command has.
    """
    place, found = Path(pipeline.files.place(pipeline.file)), installed()
    if (pipeline.registry or found) is not found or not _holds(place, pipeline.text):
        return ""
    for name in found.names("pipelines"):
        if os.path.abspath(found.path("pipelines", name)) == os.path.abspath(place):
            return name
    return pipeline.file if os.path.abspath(pipeline.file) == os.path.abspath(place) else str(place)


def _holds(place: Path, text: str) -> bool:
    try:
        return place.is_file() and text_of_file(place) == text
    except (OSError, UnicodeDecodeError, UsageError):
        return False


def spelled(name: str, settings: Mapping[str, Any], only: tuple[str, ...]) -> str:
    """Return a variant as it can be given again: one argument, quoted where it must be."""
    words = [name]
    for key, value in settings.items():
        words += ["--set", f"{key}={as_yaml(value)}"]
    for node in only:
        words += ["--only", node]
    return pasted(shlex.join(words) if len(words) > 1 else name)


def as_yaml(value: Any) -> str:
    """Return a setting's value as YAML on one line."""
    value = plain(value)
    if isinstance(value, bool):
        return "true" if value else "false"
    if value is None:
        return "null"
    if isinstance(value, list):
        return f"[{', '.join(as_yaml(v) for v in value)}]"
    if isinstance(value, dict):
        return f"{{{', '.join(f'{k}: {as_yaml(v)}' for k, v in value.items())}}}"
    return repr(value) if isinstance(value, float) else str(value)
