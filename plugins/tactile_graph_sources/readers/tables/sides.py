"""Sections of a table that belong to the left or the right of two sensors, by their titles.

``[Left]``, ``Side: Right``, ``Frame 3 (left)``, ``Left insole / Frame 3``.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

from tactile_graph.errors import one_of
from tactile_graph_sources.readers.choice import SeveralSensorsError
from tactile_graph_sources.readers.tables.breaks import (
    FRAME_LINE,
    LONGEST_SIGNATURE,
    signature,
    stamp_of,
)
from tactile_graph_sources.readers.tables.table import is_blank, is_comment
from tactile_graph_sources.readers.words.dialect import Dialect, is_row

_SIDES = (
    {"left", "links", "linke", "linker", "gauche", "izquierdo", "izquierda", "sinistro",
     "sinistra", "l"},
    {"right", "rechts", "rechte", "rechter", "droit", "droite", "derecho", "derecha", "destro",
     "destra", "r"},
)  # fmt: skip
_THINGS = {
    "foot": {"foot", "insole", "sole", "shoe", "fuß", "fuss", "pied", "pie", "piede", "sohle",
             "semelle", "plantilla"},
    "hand": {"hand", "glove"},
}  # fmt: skip
_BESIDE = {
    "side", "sensor", "pad", "mat", "frame", "bild", "image", "trame", "cuadro", "scan", "sample",
    "seite", "lado", "lato", "côté", "time", "zeit", "temps", "tiempo", "tempo", "t", "s", "ms",
    "sec", "seconds", "data", "matrix", "number", "no", "nr", *_THINGS["foot"], *_THINGS["hand"],
}  # fmt: skip
"""What else such a title may say."""
_WORD = re.compile(r"[^\W\d_]+")


@dataclass(frozen=True)
class Side:
    """Which of the two is read.

    Parameters
    ----------
    which : int
        0 or 1.
    name : str
        As the first title says it.
    title : str
        That title.
    things : frozenset of str
        What the title says it is the side of.
    apart : bool
        Whether the file has several such things.
    alone : bool
        Whether the first lines hold no other, so that one further on is a surprise.
    loose : frozenset of str
        What comments and other lines say of both sides, where they are titles, too.
    before : frozenset of str
        What lines say that tell of a frame before the title of its section.
    """

    which: int
    name: str
    title: str = ""
    things: frozenset[str] = frozenset()
    apart: bool = False
    alone: bool = False
    loose: frozenset[str] = frozenset()
    before: frozenset[str] = frozenset()


def side_of(title: str, loose: frozenset[str] = frozenset()) -> Side | None:
    """Return the side that a line names, if it is the title of a section; None otherwise.

    Parameters
    ----------
    title : str
    loose : frozenset of str
        Of which other lines are titles, too.
    """
    if len(title) > LONGEST_SIGNATURE or title.lower() == title.upper():
        return None
    words = _WORD.findall(title)
    found = [(k, w) for w in words for k in (0, 1) if w.lower() in _SIDES[k]]
    if len(found) != 1 or is_row(title):
        return None
    which, name = found[0]
    others = {w.lower() for w in words if w != name}
    if (is_comment(title) or not others <= _BESIDE) and _of_either(title, name) not in loose:
        return None
    return Side(which, name, title.strip(), _things(others))


def _things(words: set[str]) -> frozenset[str]:
    known = {thing for thing, names in _THINGS.items() if words & names}
    return frozenset(known | (words - _BESIDE))


def _of_either(title: str, name: str) -> str:
    return signature(re.sub(rf"\b{name}\b", "<side>", title))


def loose_titles(lines: Sequence[str]) -> frozenset[str]:
    """Return what comments and other lines say of both sides, for `side_of`."""
    found: tuple[set[str], set[str]] = (set(), set())
    for line in lines:
        if len(line) > LONGEST_SIGNATURE or line.lower() == line.upper():
            continue
        for name in _WORD.findall(line):
            for k in (0, 1):
                if name.lower() in _SIDES[k]:
                    found[k].add(_of_either(line, name))
    return frozenset(found[0] & found[1])


def sides_of(lines: Sequence[str], loose: frozenset[str] = frozenset()) -> list[Side]:
    """Return the sides that sections with rows are of; none where rows stand before a title.

    Numbers before the first title, of which there are more or fewer than in a row, are no row.
    """
    found: dict[tuple[int, frozenset[str]], Side] = {}
    side: Side | None = None
    above: list[str] = []
    for line in lines:
        named = side_of(line, loose)
        if named is not None:
            side = named
        elif side is None:
            above.append(line)
        elif is_row(line) and (key := (side.which, side.things)) not in found:
            if not found and _are_rows(above, line):
                return []
            found[key] = side
    if not found:
        return []
    stamps = map(stamp_of, above)
    told = zip(above, stamps, strict=True)
    before = frozenset(signature(x) for x, s in told if s.frame is not None or s.time is not None)
    apart = len({side.things for side in found.values()} - {frozenset()}) > 1
    sides = [replace(s, apart=apart, loose=loose, before=before) for s in found.values()]
    return sides if apart else [s for k, s in enumerate(sides) if s.which not in _which(sides[:k])]


def are_numbered_alike(lines: Sequence[str], loose: frozenset[str]) -> bool:
    """Return whether frames of both sides have one number, so that they are no one series."""
    found: tuple[set[str], set[str]] = (set(), set())
    side: Side | None = None
    for line in lines:
        side = side_of(line, loose) or side
        if side is not None and (label := FRAME_LINE.fullmatch(line)):
            found[side.which].add(label[1])
    return not found[0].isdisjoint(found[1])


def _which(sides: Iterable[Side]) -> set[int]:
    return {side.which for side in sides}


def _are_rows(above: Sequence[str], row: str) -> bool:
    """Return whether one of the lines before the first title is a row as those behind it are."""
    rows = [line for line in above if is_row(line)]
    dialect = Dialect.of([row])
    return any(len(dialect.fields(line)) == len(dialect.fields(row)) for line in rows)


def asked_of(sides: Sequence[Side], sensor: str) -> Side | None:
    """Return the side that a setting means; None where it names none.

    Raises
    ------
    ValueError
        If it may be several of them.
    """
    words = {w.lower() for w in _WORD.findall(sensor)}
    which = [k for k in (0, 1) if words & _SIDES[k]]
    if len(which) != 1:
        return None
    things = _things(words - _SIDES[which[0]])
    if which[0] not in _which(sides) and things <= _THINGS.keys():
        return replace(sides[0], which=which[0])  # further on
    found = [
        side
        for side in sides
        if side.which == which[0] and things <= (side.things or _THINGS.keys())
    ]
    if len(found) > 1:
        raise ValueError(f"sensor={sensor} may be any of {one_of(names_of(found))}")
    return found[0] if found else None


def names_of(sides: Iterable[Side]) -> tuple[str, ...]:
    """Return what sides are called, and of what they are where that tells them apart."""
    return tuple(" ".join([s.name, *(sorted(s.things) if s.apart else ())]) for s in sides)


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
    mine, held = True, list[tuple[int, str]]()
    for number, line in lines:
        named = side_of(line, side.loose)
        if named is not None:
            mine = named.which == side.which and (not side.apart or named.things == side.things)
            if side.alone and not mine:
                names = side.name, named.name
                raise SeveralSensorsError(f"{where}:{number}", of_several(names), names)
            yield from held
            held.clear()
            told = mine and any(c.isdigit() for c in line)
            yield number, line if told else ""
        elif mine:
            yield number, line
        elif side.before and (signature(line) in side.before or (held and is_blank(line))):
            held.append((number, line))  # it tells of the frame whose title follows
        else:
            yield from ((k, "") for k, _ in held)
            held.clear()
            yield number, ""


def of_several(names: Iterable[str]) -> str:
    """Return what to ask where the sections of a table are of several sensors."""
    return (
        f"its sections are those of several sensors, as their titles say: {', '.join(names)}; "
        "name one with sensor"
    )
