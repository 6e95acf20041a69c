"""Units of pressure and length as vendors spell them."""

from __future__ import annotations

import re

_KILOPASCAL = {
    "pa": 1e-3,
    "hpa": 0.1,
    "kpa": 1.0,
    "mpa": 1e3,
    "bar": 100.0,
    "mbar": 0.1,
    "mmhg": 0.133322387415,
    "cmhg": 1.33322387415,
    "inhg": 3.386388640341,
    "torr": 0.133322368421,
    "mmh2o": 0.00980665,
    "cmh2o": 0.0980665,
    "inh2o": 0.24908891,
    "psi": 6.894757293168,
    "lb/in2": 6.894757293168,
    "lbf/in2": 6.894757293168,
    "lbs/in2": 6.894757293168,
    "n/m2": 1e-3,
    "kn/m2": 1.0,
    "n/cm2": 10.0,
    "n/mm2": 1e3,
    "kg/cm2": 98.0665,
    "kgf/cm2": 98.0665,
    "kp/cm2": 98.0665,
    "g/cm2": 0.0980665,
    "gf/cm2": 0.0980665,
    "atm": 101.325,
    "pascal": 1e-3,
    "kilopascal": 1.0,
}
SQUARED = re.compile(r"²|\\xb2|\*\*2|\^2")
"""How files raise to the second power; a Latin-1 sign is not decoded in a text of UTF-8."""
_VALUES = {
    "v": ("volt", 1.0), "volt": ("volt", 1.0), "volts": ("volt", 1.0), "mv": ("volt", 1e-3),
    "g": ("gram", 1.0), "gram": ("gram", 1.0), "grams": ("gram", 1.0), "kg": ("gram", 1e3),
    "count": ("counts", 1.0), "counts": ("counts", 1.0), "adc": ("counts", 1.0),
    "lsb": ("counts", 1.0), "siemens": ("siemens", 1.0),
    "vdc": ("volt", 1.0), "mvdc": ("volt", 1e-3),
}  # fmt: skip
UNIT_WORDS = frozenset({
    "unit", "units", "einheit", "unité", "unite", "unidad", "unidades", "unità", "unita",
    "pressure unit", "pressure_unit",
})  # fmt: skip
"""What a line or a column is called that says a unit."""
NO_UNITS = frozenset({"raw", "a.u.", "au", "-", "1", "arb. units"})
OHMS = re.compile(r"[km]?(?:ohms?|ω)")
_CENTIMETRES = {"mm": 0.1, "cm": 1.0, "m": 100.0, "in": 2.54, "inch": 2.54, "inches": 2.54}
_CENTIMETRES |= dict.fromkeys(("um", "\u00b5m", "\u03bcm", r"\xb5m"), 1e-4)
_PREFIXES = {"milli": 0.1, "centi": 1.0, "micro": 1e-4}
_CENTIMETRES |= {f"{n}met{e}": f for n, f in _PREFIXES.items() for e in ("er", "re")}
_LENGTH = re.compile(r"([-+]?[\d.,]+(?:[eE][-+]?\d+)?)\s*([a-zA-Z\u00b5\u03bc]+)")


def pressure_unit(text: str) -> tuple[str, float]:
    """Return the quantity a unit stands for and the factor to it.

    Parameters
    ----------
    text : str
        A unit as a file spells it: ``mmHg``, ``KPa``, ``N/cm²``, ``raw``.

    Returns
    -------
    (str, float)
        ``("kilopascal", factor)`` for pressures, ``("raw", 1.0)`` for anything else.
    """
    name = SQUARED.sub("2", text.strip().strip('"').lower().replace(" ", ""))
    name = name.removesuffix("s") if name not in _KILOPASCAL else name
    factor = _KILOPASCAL.get(name)
    return ("raw", 1.0) if factor is None else ("kilopascal", factor)


def value_unit(text: str) -> tuple[str, float]:
    """Return the quantity that a unit or a name of values stands for, and the factor to it.

    Parameters
    ----------
    text : str
        ``mV``, ``kPa``, ``g``, ``adc``.

    Returns
    -------
    (str, float)
        ``("volt", 1e-3)`` and so on; ``("raw", 1.0)`` for anything else.
    """
    return _VALUES.get(text.strip().lower(), pressure_unit(text))


def taken_as_they_are(unit: str) -> tuple[str, ...]:
    """Return the note on values in a unit that stands for no known quantity; none for others."""
    unit = unit.strip().strip('"')
    name = unit.lower()
    if value_unit(unit)[0] != "raw" or name in NO_UNITS or not any(c.isalpha() for c in unit):
        return ()
    falls = ", which falls under load" if OHMS.fullmatch(name) else ""
    return (f"values in {unit!r}{falls} taken as they are",)


def length_unit(name: str) -> float | None:
    """Return the centimetres of the unit a name ends with, as ``x_mm`` or ``y [cm]`` do."""
    unit = re.split(r"[_\s(\[]+", name.strip().rstrip(")]").lower())[-1]
    return _CENTIMETRES.get(unit)


def without_length_unit(name: str) -> tuple[str, str]:
    """Return a name and the unit of length that it ends with: ``pitch mm``; empty where none."""
    stem, _, unit = name.rpartition(" ")
    return (stem, unit) if stem and unit in _CENTIMETRES else (name, "")


def length_cm(text: str, unit: str = "") -> float | None:
    """Return a length in cm, as ``"5.08 mm"`` gives 0.508; None where it is no positive length.

    Parameters
    ----------
    text : str
        Number and unit.
    unit : str
        The unit, where it stands elsewhere.
    """
    found = _LENGTH.search(f"{text} {unit}")
    if found is None:
        return None
    name = found[2].lower()
    factor = _CENTIMETRES.get(name) or _CENTIMETRES.get(name.removesuffix("s"))
    try:
        number = float(found[1].replace(",", "."))
    except ValueError:
        return None
    return number * factor if factor and 0.0 < number < 1e6 else None
