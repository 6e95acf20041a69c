"""A pipeline's data as the text of its file, a line a node, comments above what they are about."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from tactile_graph.pipeline.document import in_yaml

WIDTH = 98


@dataclass(frozen=True)
class Notes:
    """Comments: of the file, and of conditions and nodes by name."""

    of: Mapping[str, str]
    head: str = ""


def text_of(data: Mapping[str, Any], notes: Notes) -> str:
    """Return the text of a pipeline file."""
    return "\n".join(_lines(data, notes)) + "\n"


def _lines(data: Mapping[str, Any], notes: Notes) -> Iterator[str]:
    yield from _comment(notes.head, "")
    for key, value in data.items():
        if key in ("conditions", "nodes"):
            yield f"{key}:"
            for name, entry in value.items():
                yield from _comment(notes.of.get(name, ""), "  ")
                yield f"  {name}: {_flow(entry)}"
        else:
            yield f"{key}: {_flow(value)}"


def _comment(text: str, indent: str) -> Iterator[str]:
    for line in text.splitlines():
        for part in textwrap.wrap(line, WIDTH - len(indent) - 2):
            yield f"{indent}# {part}"


def _flow(value: Any) -> str:
    text = in_yaml(value, default_flow_style=True, width=10**6, sort_keys=False, allow_unicode=True)
    return text.removesuffix("\n").removesuffix("\n...").rstrip()
