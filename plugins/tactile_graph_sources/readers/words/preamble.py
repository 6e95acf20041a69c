"""What the lines before a table say of it: ``Rows: 12``, ``Raster: 5 mm``, ``Einheit = kPa``."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.quantities import is_quantity
from tactile_graph_sources.readers.words.pitches import (
    PITCH_WORDS,
    SaidPitch,
    pitch_of,
    said_pitch,
)
from tactile_graph_sources.readers.words.rates import frame_seconds, of_something_else
from tactile_graph_sources.readers.words.units import (
    UNIT_WORDS,
    taken_as_they_are,
    value_unit,
    without_length_unit,
)

PAIRS = ("pitch_cm", "origin_cm")
_PAIR = re.compile(r"[\s#%/\"']*([^:=;,\t]{1,40}?)\s*([:=;,\t]+)\s*(\"?)(.*?)[\s\",;]*")
_WORDS = {
    "rows": {"rows", "row", "zeilen", "reihen", "lignes", "filas", "righe", "number of rows",
             "n rows", "num rows", "nrows"},
    "columns": {"columns", "column", "cols", "spalten", "colonnes", "columnas", "colonne",
                "number of columns", "n cols", "num cols", "num columns", "ncols"},
    "shape": {"shape", "size", "matrix", "grid", "resolution", "dimensions", "sensor size",
              "größe", "matriz", "matrice", "taille", "array"},
    "pitch": frozenset(PITCH_WORDS),
    "unit": UNIT_WORDS,
    "scale": {"scale factor", "scaling factor", "multiplier", "skalierungsfaktor"},
    "quantity": {"quantity"},
    "rate": {"frame rate", "sampling rate", "sample rate", "fps", "fs", "sampling frequency",
             "scanning rate", "sample rate hz", "rate hz", "abtastrate"},
    "any rate": {"rate", "frequency", "frequenz", "fréquence", "frecuencia", "frequenza",
                 "cadence"},
}  # fmt: skip
_MEANING = {word: key for key, words in _WORDS.items() for word in words}
_SHAPE = re.compile(r"\D*?(\d{1,5})\s*(?:x|×|\*|,|by|mal)\s*(\d{1,5})\b.*", re.IGNORECASE)
_RATES = ("rate", "any rate")
_LONGEST = 100
"""Of what is said of pitch and rate: longer texts are something else."""
_NUMBER = re.compile(r"[-+]?\d+(?:[.,]\d+)?")


@dataclass(frozen=True)
class Described:
    """What a table says of itself in words; None where it says nothing."""

    rows: int | None = None
    columns: int | None = None
    pitch_cm: tuple[float, float] | None = None
    quantity: str = "raw"
    factor: float = 1.0
    frame_s: float | None = None
    origin_cm: tuple[float, float] | None = None
    strange_unit: str = field(default="", compare=False)
    """A unit that stands for no known quantity."""
    told: tuple[str, ...] = field(default=(), compare=False)
    """What is left out of it, or taken without being said."""

    def in_unit(self, unit: str) -> Described:
        """Return what is said with a unit of the values; one not known takes back no quantity."""
        quantity, factor = value_unit(unit)
        if quantity == "raw":
            return replace(self, strange_unit=unit)
        return replace(self, quantity=quantity, factor=factor)

    @property
    def notes(self) -> tuple[str, ...]:
        """What is told of it, and of values that nobody says the quantity of."""
        strange = taken_as_they_are(self.strange_unit) if self.quantity == "raw" else ()
        return *strange, *self.told


def described_by(named: Mapping[str, Any]) -> Described:
    """Return what named values say that stand beside a stack, as arrays or attributes.

    Parameters
    ----------
    named : mapping
        Name -> text, number, or array of one or two; others say nothing. Two that are called
        ``pitch_cm`` or ``origin_cm``, as in files of ours, are along x and y.
    """
    values = {name: _flat(value) for name, value in named.items()}
    said = described(f"{name}: {_plain(v[0])}" for name, v in values.items() if v.size == 1)
    for name, pair in values.items():
        if name in PAIRS and pair.size == 2 and pair.dtype.kind in "iuf":
            x, y = map(float, pair)
            pitch = name == "pitch_cm"
            if np.isfinite(pair).all() and (not pitch or min(x, y) > 0):
                said = replace(said, pitch_cm=(x, y)) if pitch else replace(said, origin_cm=(x, y))
    return said


def _flat(value: Any) -> NDArray[Any]:
    try:
        return np.ravel(np.asarray(value))
    except ValueError:  # lists of unlike lengths
        return np.empty(0)


def _plain(value: Any) -> Any:
    return value.decode("utf-8", "backslashreplace") if isinstance(value, bytes) else value


def described(lines: Iterable[str]) -> Described:
    """Return what the lines before a table say of its shape, pitch, unit and rate."""
    said, pitches = Described(), list[SaidPitch]()
    for line in lines:
        found = _PAIR.fullmatch(line)
        if found is None:
            continue
        key, _, unit = found[1].strip().lower().replace("_", " ").partition("[")
        key, _, other = key.partition("(")
        bare, length = without_length_unit(key.strip())
        meaning, value = _MEANING.get(bare), found[4]
        if meaning == "pitch":
            beside, in_fields = f"{other} {unit} {length}", found[2] == "," and not found[3]
            line_said = said_pitch(_shown(found), bare, value[:_LONGEST], beside, in_fields)
            pitches += [] if line_said is None else [line_said]
        elif meaning is not None:
            unit = (unit or other).strip(" ])") or length
            said = _take(said, meaning, value, unit)
            said = replace(said, told=(*said.told, *_unread(said, meaning, found, unit)))
    pitch, notes = pitch_of(pitches)
    return replace(said, pitch_cm=pitch, told=(*said.told, *notes))


def _shown(found: re.Match[str]) -> str:
    return f"{found[1].strip()}: {found[4][:_LONGEST]}"


def _unread(said: Described, meaning: str, found: re.Match[str], unit: str) -> tuple[str, ...]:
    """Return what is told of a line that says something which is not followed."""
    first = _NUMBER.match(found[4])
    number = float(first[0].replace(",", ".")) if first else 0.0
    if meaning in _RATES and number and said.frame_s is None:
        if meaning == "any rate" and of_something_else(found[4][:_LONGEST], unit):
            return ()
        return (f"{_shown(found)!r} left out, as it is no rate that is understood (such as 50 Hz)",)
    if meaning == "scale" and number not in (0.0, 1.0) and _NUMBER.fullmatch(found[4]):
        remedy = f"the step gain with elements: [[{1.0 / number:g}]] does it"
        return (f"{_shown(found)!r} not applied to the values; {remedy}",)
    return ()


def _take(said: Described, meaning: str, value: str, unit: str) -> Described:
    if meaning in ("rows", "columns"):
        n = int(value) if value.isdecimal() and 0 < int(value[:9]) < 10**5 else None
        if n is None:
            return said
        return replace(said, rows=n) if meaning == "rows" else replace(said, columns=n)
    if meaning == "shape":
        found = _SHAPE.fullmatch(value)
        return said if found is None else replace(said, rows=int(found[1]), columns=int(found[2]))
    if meaning == "unit":
        return said.in_unit(value)
    if meaning == "quantity":
        quantity, factor = (value, 1.0) if is_quantity(value) else value_unit(value)
        if quantity in ("raw", said.quantity):  # a unit of it has told its factor, too
            return said
        return replace(said, quantity=quantity, factor=factor)
    if meaning not in _RATES:
        return said
    frame_s = frame_seconds(value[:_LONGEST], unit, of_frames=meaning == "rate")
    return replace(said, frame_s=frame_s) if frame_s and frame_s > 1e-6 else said
