"""Read numpydoc docstrings: what each parameter means, and the sections for people."""

from __future__ import annotations

import re

_SECTION = re.compile(r"^(?P<title>[A-Z][A-Za-z ]+)\n-{3,}\n", re.M)


def sections(doc: str) -> dict[str, str]:
    """Return the sections of a dedented docstring by title; the prose before them under ``""``."""
    found = list(_SECTION.finditer(doc))
    starts = [*(m.start() for m in found), len(doc)]
    parts = {"": doc[: starts[0]]}
    for match, end in zip(found, starts[1:], strict=True):
        parts[match["title"]] = doc[match.end() : end]
    return {title: text.strip() for title, text in parts.items()}


def parameters(doc: str) -> dict[str, str]:
    """Return what each documented parameter means, as one line."""
    meanings: dict[str, str] = {}
    names: list[str] = []
    for line in sections(doc).get("Parameters", "").splitlines():
        if line and not line[0].isspace():
            names = [n.strip().lstrip("*") for n in line.partition(":")[0].split(",")]
            meanings.update(dict.fromkeys(names, ""))
        elif line.strip():
            for name in names:
                meanings[name] = f"{meanings[name]} {line.strip()}".strip()
    return meanings
