"""Find things by words: what each is called, says of itself, and can be told."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

WHOLE, BEGINNING, INSIDE = 4, 3, 1
"""How well a word is met by one that is it, begins with it, or is much like it or holds it."""
LEAST_ALIKE, SHARE_ALIKE = 4, 0.75
"""Letters, and share of the word searched for, that a word much like it begins with too."""


class Entry(NamedTuple):
    """What is searched: a name, a line about it, and its parts (settings, steps) by name."""

    name: str
    about: str
    parts: Mapping[str, str]


class Hit(NamedTuple):
    """An entry that mentions every word, and which of its parts do so."""

    entry: Entry
    parts: tuple[str, ...]


def best_first(words: Sequence[str], entries: Iterable[Entry]) -> list[Hit]:
    """Return the entries that mention every word: those named so first, then by what they say."""
    wanted = [w for text in words for w in _words(text)]
    found = []
    for entry in entries:
        scores = [_score(word, entry) for word in wanted]
        if scores and all(scores):
            found.append((-sum(scores), entry.name, Hit(entry, _parts(wanted, entry))))
    return [hit for *_, hit in sorted(found)]


def _score(word: str, entry: Entry) -> int:
    """Return how well an entry meets a word; its name counts most, then the line about it."""
    parts = [f"{name} {text}" for name, text in entry.parts.items()]
    return max(100 * _met(word, entry.name), 10 * _met(word, entry.about),
               *(_met(word, text) for text in parts), 0)  # fmt: skip


def _parts(words: Sequence[str], entry: Entry) -> tuple[str, ...]:
    return tuple(
        name for name, text in entry.parts.items() if any(_met(w, f"{name} {text}") for w in words)
    )


def _met(word: str, text: str) -> int:
    """Return how well the best word of a text meets one; 0 for not at all."""
    return max((_likeness(word, other) for other in _words(text)), default=0)


def _likeness(word: str, other: str) -> int:
    if other == word or other == f"{word}s" or word == f"{other}s":
        return WHOLE
    if other.startswith(word):
        return BEGINNING
    alike = 0
    for a, b in zip(word, other, strict=False):
        if a != b:
            break
        alike += 1
    near = alike >= max(LEAST_ALIKE, SHARE_ALIKE * len(word))
    return INSIDE if near or (len(word) >= LEAST_ALIKE and word in other) else 0


def _words(text: str) -> list[str]:
    return re.findall(r"[^\W_]+", text.lower())
