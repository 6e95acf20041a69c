"""Sections of a table that belong to the left or the right of two sensors, by their titles.

``[Left]``, ``Side: Right``, ``Frame 3 (left)``, ``Left insole / Frame 3``.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from tactile_graph_sources.readers.choice import SeveralSensorsError
from tactile_graph_sources.readers.tables.breaks import LONGEST_SIGNATURE
from tactile_graph_sources.readers.words.dialect import is_row

_SIDES = (
    {"left", "links", "linke", "linker", "gauche", "izquierdo", "izquierda", "sinistro",
     "sinistra", "l"},
    {"right", "rechts", "rechte", "rechter", "droit", "droite", "derecho", "derecha", "destro",
     "destra", "r"},
)  # fmt: skip
_BESIDE = {
    "foot", "insole", "sole", "side", "sensor", "hand", "glove", "shoe", "pad", "mat", "frame",
    "bild", "image", "trame", "cuadro", "scan", "sample", "fuß", "fuss", "pied", "pie", "piede",
    "seite", "lado", "lato", "côté", "sohle", "semelle", "plantilla", "time", "zeit", "temps",
    "tiempo", "tempo", "t", "s", "ms", "sec", "seconds", "data", "matrix", "number", "no", "nr",
}  # fmt: skip
"""What else such a title may say."""
_WORD = re.compile(r"[^\W\d_]+")


class Side(NamedTuple):
    """Which of the two is read: 0 or 1, and its name.

    ``alone`` says that the first lines hold no other, so that one further on is a surprise.
    """

    which: int
    name: str
    alone: bool = False


def side_of(title: str) -> Side | None:
    """Return the side that a line names, if it is the title of a section; None otherwise."""
    if len(title) > LONGEST_SIGNATURE or title.lower() == title.upper():
        return None
    words = _WORD.findall(title)
    found = [Side(k, w) for w in words for k in (0, 1) if w.lower() in _SIDES[k]]
    if len(found) != 1 or is_row(title):
        return None
    others = {w.lower() for w in words if w != found[0].name}
    return found[0] if others <= _BESIDE else None


def sides_of(lines: Sequence[str]) -> dict[int, Side]:
    """Return the sides that sections with rows are of; none where rows stand before a title."""
    found: dict[int, Side] = {}
    side: Side | None = None
    for line in lines:
        named = side_of(line)
        if named is not None:
            side = named
        elif is_row(line):
            if side is None:
                return {}
            found.setdefault(side.which, side)
    return found


def of_side(
    lines: Iterable[tuple[int, str]], side: Side | None, where: str
) -> Iterator[tuple[int, str]]:
    """Return numbered lines with blank ones for those of the other side, and for bare titles.

    Raises
    ------
    SeveralSensorsError
        If, on the way, there is another side than the one that is read alone.
    """
    return iter(lines) if side is None else _of_side(lines, side, where)


def _of_side(lines: Iterable[tuple[int, str]], side: Side, where: str) -> Iterator[tuple[int, str]]:
    mine = True
    for number, line in lines:
        named = side_of(line)
        if named is None and mine:
            yield number, line
            continue
        if named is not None:
            mine = named.which == side.which
            if side.alone and not mine:
                names = side.name, named.name
                raise SeveralSensorsError(f"{where}:{number}", of_several(names), names)
        told = mine and any(c.isdigit() for c in line)
        yield number, line if told else ""


def of_several(names: Iterable[str]) -> str:
    """Return what to ask where the sections of a table are of several sensors."""
    return (
        f"its sections are those of several sensors, as their titles say: {', '.join(names)}; "
        "name one with sensor"
    )
