"""How often frames come, as lines before a table say it: ``0.5 kHz``, ``3000 frames/min``."""

from __future__ import annotations

import re

_SECONDS = {"s": 1.0, "sec": 1.0, "second": 1.0, "min": 60.0, "minute": 60.0, "h": 3600.0,
            "hour": 3600.0}  # fmt: skip
_PERIODS = {"s": 1.0, "sec": 1.0, "ms": 1e-3, "msec": 1e-3, "us": 1e-6, "µs": 1e-6, "μs": 1e-6}
_RATES = {"": 1.0, "hz": 1.0, "hertz": 1.0, "fps": 1.0, "sps": 1.0, "khz": 1e3, "s-1": 1.0,
          "s^-1": 1.0}  # fmt: skip
_VALUE = re.compile(
    r"([-+]?\d+(?:[.,]\d+)*(?:e[-+]?\d+)?)(?![.,]?\d)\s*"
    r"((?:1|[^\W\d]+)?\s*(?:/|\bper\s)\s*[a-z]+|s\^?-1|[^\W\d_]+)?(?![\w/])\s*(\D?).*"
)
_PER = re.compile(
    r"(?:1|frames?|samples?|scans?|images?|pictures?|bilder)?\s*(?:/|per\s)\s*([a-z]+?)s?"
)


def frame_seconds(text: str, unit: str = "") -> float | None:
    """Return the time from frame to frame that a rate stands for, or a period instead of one.

    Parameters
    ----------
    text : str
        Number and unit; without one it is in hertz.
    unit : str
        The unit, where it stands elsewhere.

    Returns
    -------
    float, optional
        In seconds; None where it is not understood, or may mean two things: ``1,000 Hz``.
    """
    found = _VALUE.fullmatch(text.strip().lower())
    if found is None or (found[2] is None and found[3] not in ("", "(", ",", ";")):
        return None
    number, name = _number(found[1]), (found[2] or unit).strip().lower()
    if not 1e-9 < number < 1e12:
        return None
    if name in _PERIODS:
        return number * _PERIODS[name]
    per = _PER.fullmatch(name)
    if per is not None and per[1] in _SECONDS:
        return _SECONDS[per[1]] / number
    return 1.0 / (number * _RATES[name]) if name in _RATES else None


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
