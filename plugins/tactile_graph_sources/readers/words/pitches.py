"""What lines before a table say of how far apart cells lie: ``Pitch: 8 mm x 12 mm``."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

from tactile_graph_sources.readers.words.units import length_cm

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


class SaidPitch(NamedTuple):
    """A line on the pitch.

    Parameters
    ----------
    told : str
        The line.
    word : str
        Which of `PITCH_WORDS` it is.
    pitch_cm : (float, float), optional
        Along x and y; None where it cannot be told.
    """

    told: str
    word: str
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
    text = re.sub(r"(?<=\S)\s*\([^)]*\)", " ", text.lower())
    if not fields and "." not in text:
        text = re.sub(r"(?<=\d),(?=\d)", ".", text)
    text = re.sub(r"[,;\t()\"]+", " ", re.split(r"±|\+\s?/?\s?-", text)[0]).strip()
    if (two := _TWO.fullmatch(text)) is not None:
        x = length_cm(two[1], two[2] or two[4] or unit)
        y = length_cm(two[3], two[4] or two[2] or unit)
        if x is not None and y is not None:
            return x, y
    if (one := _ONE.fullmatch(text)) is not None:
        length = length_cm(one[1], one[2] or unit)
        return None if length is None else (length, length)
    # a length, and behind it what is none, or the same one: "8 mm, 64 cells", "1 in / 25.4 mm"
    found = [(length_cm(n, word), word) for n, word in _WITH_WORD.findall(text)]
    first = found[0][0] if found else None
    if first is None or any(not w or abs((cm or first) / first - 1) > 0.02 for cm, w in found):
        return None
    return first, first


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


def _along(lines: Sequence[SaidPitch], axis: int) -> tuple[set[float], bool]:
    """Return what is said along an axis, and whether that is the size of cells."""
    found: tuple[set[float], set[float]] = set(), set()
    for _, word, pitch_cm in lines:
        side, of_size = PITCH_WORDS[word]
        if pitch_cm is not None and side in ("", "xy"[axis]):
            found[of_size].add(pitch_cm[axis])
    return (found[0], False) if found[0] else (found[1], bool(found[1]))
