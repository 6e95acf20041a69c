"""How many words there are to read, by kind of page; tables and blocks are looked up, not read."""

from __future__ import annotations

import re
from pathlib import Path

MOST_WORDS = 2000
"""Of a page that is read through."""
KINDS = {
    "user guides": "index tutorial/ how-to/ reference glossary pipelines files recordings devices "
    "compare notebook plugins hooks api contributing project live deadlines many-frames",
    "explanation": "explanation architecture pad likelihood any-pad fields objects merging "
    "stability",
    "evidence": "evidence/ reproduce errata benchmarks promises attacks evolution mutations",
}
"""Pages, and rooms of them, by kind."""
_BLOCK = re.compile(r"^(```+|:::+)[^\n]*\n.*?^\1\s*$", re.M | re.S)
_GLOSSARY = re.compile(r"^```\{glossary\}\n(.*?)^```$", re.M | re.S)


def prose_words(page: Path) -> int:
    """Return how many words of a page are read: neither in blocks nor in tables."""
    text = page.read_text("utf-8")
    told = " ".join(_GLOSSARY.findall(text))
    text = _BLOCK.sub("", text)
    lines = [line for line in text.splitlines() if not line.startswith(("|", "    "))]
    return len(" ".join([*lines, told]).split())


def all_words(page: Path) -> int:
    """Return how many words a page has."""
    return len(page.read_text("utf-8").split())


def kind_of(name: str) -> str:
    """Return the kind of a page, by its path below the docs without suffix; empty for others."""
    for kind, members in KINDS.items():
        if any(name == m or (m[-1] == "/" and name.startswith(m)) for m in members.split()):
            return kind
    return ""


def by_kind(docs: Path, pages: list[Path]) -> dict[str, tuple[int, int]]:
    """Return for each kind the words that are read, and all words."""
    counts = dict.fromkeys(KINDS, (0, 0))
    for page in pages:
        kind = kind_of(page.relative_to(docs).with_suffix("").as_posix())
        if kind:
            read, every = counts[kind]
            counts[kind] = read + prose_words(page), every + all_words(page)
    return counts
