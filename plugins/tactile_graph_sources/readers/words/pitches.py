"""What lines before a table say of how far apart cells lie: ``Pitch: 8 mm x 12 mm``."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

from tactile_graph_sources.readers.words.units import SQUARED, length_cm, length_unit

_CELLS = ("cell", "sensel", "element", "taxel")
_OF_SIDES = {
    "": ("pitch", "spacing", "raster", "rastermaß", "pas", "paso", "passo", "sensor pitch",
         "sensor spacing", "grid spacing", *(f"{c} {w}" for c in _CELLS
                                            for w in ("pitch", "spacing"))),
    "x": ("column spacing", "col spacing", "column pitch", "col pitch", "pitch x", "x pitch",
          "spacing x", "x spacing", "horizontal pitch", "horizontal spacing"),
    "y": ("row spacing", "row pitch", "pitch y", "y pitch", "spacing y", "y spacing",
          "vertical pitch", "vertical spacing"),
}  # fmt: skip
_SIZES = {"size": "", "width": "x", "height": "y"}
PITCH_WORDS = {word: (side, False) for side, words in _OF_SIDES.items() for word in words}
PITCH_WORDS |= {f"{c} {w}": (side, True) for c in _CELLS for w, side in _SIZES.items()}
"""Word -> the side it is said of, none for both, and whether it is that of a cell itself."""
_NUMBER = r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?"
_UNIT = r"(?!(?:x|by|mal)\b)[a-zµμ]+?"
_ONE = re.compile(rf"({_NUMBER})\s*({_UNIT})?")
_TWO = re.compile(
    rf"({_NUMBER})\s*({_UNIT})?(?:\s*(?:x|×|\*|\bby|\bmal)\s*|\s+)({_NUMBER})\s*({_UNIT})?"
)
_WITH_WORD = re.compile(rf"({_NUMBER})\s*([^\W\d_]*)")
_OFF = re.compile(rf"({_NUMBER})\s*({_UNIT})?\s*(?:±|\+\s?/?\s?-)\s*[\d.]+\s*(?:({_UNIT})\b|%)?")
"""A length and by how much it may be off, with the unit of either."""
_AREA = re.compile(
    rf"(?:m|in|inch)(?:{SQUARED.pattern}|2\b)|\b(?:sq|square|quadrat)\W*(?:[cm]?m|in)"
)
_BESIDE = re.compile(
    rf"\W*(?:{_NUMBER}\s*{_UNIT}\s+)?(?:gap|thickness|thick|depth|margin|border|diameter|accuracy|"
    r"tolerance|total|overall|area|active area|dicke|rand|spalt)\b"
)
"""What stands beside a pitch and is none; a gap is a part of it."""
_BRACKETS = re.compile(r"(?<=\S)\s*\(([^)]*)\)")
_SIDE = re.compile(
    r"\b(?:(?P<x>x|col(?:umn)?s?|horizontal|spalten?|width)|"
    r"(?P<y>y|rows?|vertical|zeilen?|height))\b"
)
_TURN = re.compile(rf"\s*{_NUMBER}\s*(?:deg|degrees?|grad|rad|radians?|°)(?![^\W\d_])")


class SaidPitch(NamedTuple):
    """A line on the pitch.

    Parameters
    ----------
    told : str
        The line.
    word : str
        Which of `PITCH_WORDS` it is.
    side : str
        Of which it is said, ``"x"`` or ``"y"``; none for both.
    pitch_cm : (float, float), optional
        Along x and y; None where it cannot be told.
    """

    told: str
    word: str
    side: str
    pitch_cm: tuple[float, float] | None


def lengths_cm(text: str, unit: str = "", fields: bool = False) -> tuple[float, float] | None:
    """Return one length or two in cm: of ``8 mm`` twice the same, of ``8 x 12 mm`` both.

    Parameters
    ----------
    text : str
        Numbers and units; what stands in brackets behind them is left out.
    unit : str
        The unit, where it stands elsewhere.
    fields : bool
        Whether a comma always parts two fields; else it is a decimal one between two digits if
        there is no point.

    Returns
    -------
    (float, float), optional
        None where they are no lengths with a unit, or are others than one or two.
    """
    text = _BRACKETS.sub(" ", text.lower())
    if not fields and "." not in text:
        text = re.sub(r"(?<=\d),(?=\d)", ".", text)
    clauses = re.split(r";|,(?!\d)", _OFF.sub(lambda m: f"{m[1]} {m[2] or m[3] or ''}", text))
    text = ";".join(c for c in clauses if not (_BESIDE.match(c) or _AREA.search(c)))
    bare = re.sub(r"[,;\t()\"]+", " ", text).strip()
    if (two := _TWO.fullmatch(bare)) is not None:
        x = length_cm(two[1], two[2] or two[4] or unit)
        y = length_cm(two[3], two[4] or two[2] or unit)
        if x is not None and y is not None:
            return x, y
    if (one := _ONE.fullmatch(bare)) is not None:
        length = length_cm(one[1], one[2] or unit)
        return None if length is None else (length, length)
    first, semicolon, others = text.partition(";")
    of_more = re.search(rf"(?:^|;)\s*{_NUMBER}\s*(?:;|$)", others) or any(
        length_cm(*found) for found in _WITH_WORD.findall(others)
    )
    if semicolon and not of_more:
        return lengths_cm(first)  # behind it are none: "8 mm, 8x8", "8 mm; rows: 8"
    # a length, and behind it what is none, or the same one: "8 mm 64 cells", "1 in / 25.4 mm"
    found = [(length_cm(n, word), word) for n, word in _WITH_WORD.findall(bare)]
    length = found[0][0] if found else None
    if length is None or any(not w or abs((cm or length) / length - 1) > 0.02 for cm, w in found):
        return None
    return length, length


def said_pitch(told: str, word: str, text: str, beside: str, fields: bool) -> SaidPitch | None:
    """Return what a line says of the pitch; None where it is of an angle: ``Pitch: 3 deg``.

    Parameters
    ----------
    told : str
        The line.
    word : str
        Which of `PITCH_WORDS` it begins with.
    text : str
        What it says.
    beside : str
        What else belongs to the word: a unit, or the sides that lengths are of, in their order.
    fields : bool
        As of `lengths_cm`.
    """
    text, beside = text.lower(), re.sub(r"[\])]", " ", beside.lower()).strip()
    if _TURN.match(f"{text} {beside}"):
        return None
    words = [w for w in re.findall(r"[^\W\d_]+", beside) if w != "in" or w == beside]
    lengths = lengths_cm(text, next((w for w in words if length_unit(w)), ""), fields)
    side, of_size = PITCH_WORDS[word]
    order = _order_of([beside, *_BRACKETS.findall(text)])
    if lengths is not None and order == "yx":
        lengths = lengths[::-1]
    elif lengths is not None and len(order) == 1:
        lengths = lengths if lengths[0] == lengths[1] else None
        side = side or order
    if _AREA.search(beside) or (of_size and re.search(r"\b(?:gap|spalt)", text)):
        lengths = None
    return SaidPitch(told, word, side, lengths)


def _order_of(brackets: Sequence[str]) -> str:
    """Return the sides that brackets name, in their order; one with a number names none."""
    named = (m.lastgroup or "" for b in brackets if not re.search(r"\d", b)
             for m in _SIDE.finditer(b))  # fmt: skip
    return "".join(dict.fromkeys(named))


def pitch_of(lines: Sequence[SaidPitch]) -> tuple[tuple[float, float] | None, tuple[str, ...]]:
    """Return the pitch that lines say together, and what is told of it.

    Parameters
    ----------
    lines : sequence of SaidPitch

    Returns
    -------
    pitch_cm : (float, float), optional
        The size of cells where nothing says how far apart they lie; None where lines contradict
        each other.
    notes : tuple of str
        Lines that are left out, and what nobody said.
    """
    notes = [
        f"{line.told!r} left out, as it is no pitch in a known unit, nor two (of columns, of "
        "rows); pitch_cm says it"
        for line in lines
        if line.pitch_cm is None and any(c.isdigit() for c in line.told)
    ]
    if gap := _gap_beside(lines, 0) or _gap_beside(lines, 1):
        return None, (*notes, gap)
    (xs, of_size), (ys, of_size_too) = _along(lines, 0), _along(lines, 1)
    if max(len(xs), len(ys)) > 1:
        several = sorted(xs if len(xs) > 1 else ys)
        told = f"several pitches ({' and '.join(f'{p:g}' for p in several)} cm)"
        return None, (*notes, f"{told}, none of which is taken; pitch_cm says which")
    if not (xs or ys):
        return None, tuple(notes)
    if of_size or of_size_too:
        notes.append("cells taken to lie side by side, as only their size is told")
    if not (xs and ys):
        known, other = ("columns", "rows") if xs else ("rows", "columns")
        notes.append(f"{other} taken to lie as far apart as {known}, as only these are told")
    return (min(xs or ys), min(ys or xs)), tuple(notes)


def _gap_beside(lines: Sequence[SaidPitch], axis: int) -> str:
    """Return the note on a spacing that is less than the size of cells; empty where none is."""
    said = [line for line in lines if line.pitch_cm and line.side in ("", "xy"[axis])]
    spacings = [line.pitch_cm[axis] for line in said if line.pitch_cm and "spacing" in line.word]
    sizes = [line.pitch_cm[axis] for line in said if line.pitch_cm and PITCH_WORDS[line.word][1]]
    if not (spacings and sizes) or max(spacings) > 0.98 * min(sizes):
        return ""
    return (
        f"no pitch taken, as a spacing of {max(spacings):g} cm may be the gap between cells of "
        f"{min(sizes):g} cm; pitch_cm says it"
    )


def _along(lines: Sequence[SaidPitch], axis: int) -> tuple[set[float], bool]:
    """Return what is said along an axis, and whether that is the size of cells."""
    found: tuple[set[float], set[float]] = set(), set()
    for _, word, side, pitch_cm in lines:
        if pitch_cm is not None and side in ("", "xy"[axis]):
            found[PITCH_WORDS[word][1]].add(pitch_cm[axis])
    return (found[0], False) if found[0] else (found[1], bool(found[1]))
