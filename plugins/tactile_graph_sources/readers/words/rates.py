"""How often frames come, as lines before a table say it: ``0.5 kHz``, ``3000 frames/min``."""

from __future__ import annotations

import re

_SECONDS = dict.fromkeys(
    ("s", "sec", "sek", "second", "sekunde", "sekunden", "seconde", "segundo", "secondo"), 1.0
)
_SECONDS |= dict.fromkeys(("min", "minute", "minuten", "minuto"), 60.0)
_SECONDS |= dict.fromkeys(("h", "hour", "stunde"), 3600.0)
_PERIODS = {"s": 1.0, "sec": 1.0, "ms": 1e-3, "msec": 1e-3, "us": 1e-6, "µs": 1e-6, "μs": 1e-6}
_RATES = {"hz": 1.0, "hertz": 1.0, "herz": 1.0, "fps": 1.0, "sps": 1.0, "khz": 1e3, "ksps": 1e3}
_NO_UNITS = ("", "nominal", "approx", "average", "avg", "mean", "target")
_FRAMES = frozenset({
    "", "1", "f", "fr", "frame", "s", "sa", "sample", "scan", "image", "img", "picture", "bild",
    "bilder", "reading", "value", "wert", "werte", "messwert", "messwerte", "measurement",
    "messung", "messungen", "muestra", "échantillon", "campioni", "imagen", "imágene", "immagini",
    "fotograma", "fotogrammi", "point", "pt", "record", "row", "line", "zeilen", "im", "capture",
    "aufnahme", "aufnahmen",
})  # fmt: skip
"""Of what so many a second are a rate of frames, without the s of many."""
_OTHERS = frozenset({
    "n", "mn", "kn", "lbf", "lb", "kgf", "kg", "g", "mm", "cm", "m", "um", "µm", "in", "inch",
    "inche", "deg", "degree", "grad", "rad", "°", "°c", "%", "pa", "kpa", "mpa", "psi", "bar",
    "mbar", "mmhg", "v", "mv", "ml", "l", "bit", "kbit", "mbit", "byte", "kb", "mb", "b", "px",
    "pixel", "baud", "bp", "kbp", "rpm", "bpm", "press", "presse", "push", "pushe", "tap",
    "touch", "touche", "stroke", "step", "cycle", "rev", "revolution", "turn", "beat", "breath",
    "hit", "grasp", "grip", "click", "squeeze", "contact", "load",
})  # fmt: skip
"""Of what a rate is none of frames, likewise."""
_WORD = r"[^\W\d_²³]+|%|°c?"
_PER = r"(?:/|\b(?:per|pro|par|por|al|je)\b)"
_VALUE = re.compile(
    r"([-+]?\d+(?:[.,]\d+)*(?:e[-+]?\d+)?)(?![.,]?\d)"
    r"(?:-(?=[^\W\d_])|\s*(?:±|\+\s?/?\s?-)\s*[\d.,]+)?\s*"
    rf"((?:(?:1|{_WORD})?\s*(?:{_PER}\s*(?:{_WORD})\s*)+|{_WORD})?)(?![\w/-])\s*(\D?).*"
)
_BRACKETS = re.compile(r"(?<=\d)\s*[\[(]([^])]*)[])]")
_INVERSE = re.compile(r"\b(s|sec)(?:(?:\^|\*\*)?\(?[-−]1\)?|⁻¹)")
_MARKS = str.maketrans(dict.fromkeys("_\"'{}", " "))


def frame_seconds(text: str, unit: str = "", of_frames: bool = True) -> float | None:
    """Return the time from frame to frame that a rate stands for, or a period instead of one.

    Parameters
    ----------
    text : str
        Number and unit; without one it is in hertz.
    unit : str
        The unit, where it stands elsewhere.
    of_frames : bool
        Whether it is known to be a rate of frames or samples, however they are called.

    Returns
    -------
    float, optional
        In seconds; None where it is not understood, or may mean two things: ``1,000 Hz``.
    """
    number, name = _parted(text, unit)
    return number and _seconds(number, name, of_frames)


def of_something_else(text: str, unit: str = "") -> bool:
    """Return whether a rate is none of frames: ``5 N/s``, ``3 presses/min``, ``9600 baud``.

    Parameters
    ----------
    text, unit : str
        As of `frame_seconds`.
    """
    return _one(re.split(_PER, _parted(text, unit)[1])[0]) in _OTHERS


def _parted(text: str, unit: str) -> tuple[float | None, str]:
    """Return a number and its unit; None where it is none, or may be two."""
    text = _INVERSE.sub(r"/\1", text.translate(_MARKS).strip().lower())
    inner = _BRACKETS.search(text)
    if inner is not None and _seconds(1.0, inner[1].strip(), of_frames=False):
        text = _BRACKETS.sub(r" \1", text, count=1)
    found = _VALUE.fullmatch(text)
    if found is None or (not found[2] and found[3] not in ("", "(", ",", ";")):
        return None, ""
    number = _number(found[1])
    name = (found[2] or _INVERSE.sub(r"/\1", unit.lower())).strip()
    return (number if 1e-9 < number < 1e12 else None), name


def _seconds(number: float, name: str, of_frames: bool) -> float | None:
    """Return what a number of a unit is from frame to frame; None of a unit that is not known."""
    if name in _PERIODS:
        return number * _PERIODS[name]
    if name.rstrip(".") in _NO_UNITS:
        return 1.0 / number
    what, *over = (word.strip() for word in re.split(_PER, name))
    time = _SECONDS.get(over[0], _SECONDS.get(_one(over[0]))) if over else None
    if time is None:  # of each channel, if of anything
        factor = _RATES.get(what or ("hz" if of_frames and all(over) else ""))
        return factor and 1.0 / (number * factor)
    what = _one(what)
    if what in _FRAMES:
        return time / number
    if what[:1] in "km" and what[1:] in _FRAMES:
        return time / number / 1e3 if what[0] == "k" and what[1:] else None
    return time / number if of_frames and what not in _OTHERS and what not in _RATES else None


def _one(word: str) -> str:
    """Return a word without the s of many."""
    word = word.strip()
    return word.removesuffix("s") if len(word) > 2 else word


def _number(text: str) -> float:
    """Return the number, 0 where its comma may stand for thousands or decimals."""
    if re.fullmatch(r"[-+]?[1-9]\d{0,2},\d{3}", text):
        return 0.0
    if re.fullmatch(r"[-+]?[1-9]\d{0,2}(,\d{3})+(\.\d+)?", text):
        return float(text.replace(",", ""))
    try:
        return float(text.replace(",", "."))
    except ValueError:
        return 0.0
