"""Markdown written by program: tables, prose of docstrings, pages that only change if they must."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from pathlib import Path

_CODE = re.compile(r"``(.+?)``|`([^`]+)`", re.S)


def table(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table, without the columns that would stay empty; nothing without rows."""
    given = [list(row) for row in rows]
    kept = [i for i in range(len(heads)) if any(row[i] for row in given)]
    if not given:
        return ""
    lines = ["| " + " | ".join(heads[i] for i in kept) + " |", "|" + "---|" * len(kept)]
    lines += ["| " + " | ".join(_cell(row[i]) for i in kept) + " |" for row in given]
    return "\n".join(lines) + "\n"


def facts(rows: Iterable[tuple[str, str]]) -> str:
    """Return a table without heads: what it is about, and what there is to say."""
    lines = "\n".join(f"* - {name}\n  - {' '.join(text.split())}" for name, text in rows)
    return f"```{{list-table}}\n:stub-columns: 1\n\n{lines}\n```\n"


def wide(picture: str, alt: str) -> str:
    """Return a picture that is moved along where it finds no room, not made too small to read."""
    return f"```{{figure}} {picture}\n:alt: {alt}\n:figclass: wide\n```\n"


def _cell(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|")


def code(text: str) -> str:
    """Return a text as code; nothing for nothing."""
    return f"`{text}`" if text else ""


def prose(text: str) -> str:
    """Return a docstring's text: names as code, all else as it reads, indented blocks as code."""
    parts = []
    for paragraph in text.split("\n\n"):
        lines = paragraph.splitlines()
        if lines and all(line.startswith("    ") for line in lines if line):
            parts.append("```text\n" + "\n".join(line[4:] for line in lines) + "\n```")
        else:
            parts.append(_sentences(paragraph))
    return "\n\n".join(parts)


def _sentences(text: str) -> str:
    done, end = [], 0
    for found in _CODE.finditer(text):
        done.append(_plain(text[end : found.start()]))
        done.append(f"`{found[1] or found[2]}`")
        end = found.end()
    return "".join(done) + _plain(text[end:])


def _plain(text: str) -> str:
    return re.sub(r"([*_<>\[\]\\$~{])", r"\\\1", text).replace("::\n", ":\n")


def fence(language: str, text: str) -> str:
    """Return a block of code."""
    return f"```{language}\n{text.rstrip()}\n```\n"


def toctree(pages: Iterable[str], *, hidden: bool = False) -> str:
    """Return a table of contents of pages."""
    options = [":maxdepth: 1", *([":hidden:"] if hidden else [])]
    return "\n".join(["```{toctree}", *options, "", *pages, "```"]) + "\n"


def write(path: Path, text: str) -> None:
    """Write a page; one that stays as it was keeps its time, so that it is not read anew."""
    path.parent.mkdir(parents=True, exist_ok=True)
    if not path.is_file() or path.read_text("utf-8") != text:
        path.write_text(text, encoding="utf-8")
