"""What columns are called that nobody named: by numbers and letters, as programs write them."""

from __future__ import annotations

import re
from collections.abc import Sequence
from string import ascii_lowercase

_OF_COLUMN = re.compile(r"\d*|[AB]?[A-Z]")
"""As a spreadsheet's."""
_COUNTED = re.compile(r"(v|var|c|col|column|x|unnamed: ?)_?(\d+)", re.IGNORECASE)
"""As R, MATLAB, polars and pandas count them up."""


def are_nameless(names: Sequence[str]) -> bool:
    """Return whether columns are numbered or lettered only, or counted up behind one such word."""
    if all(map(_OF_COLUMN.fullmatch, names)) or [*names] == [*ascii_lowercase[: len(names)]]:
        return True
    found = [_COUNTED.fullmatch(name) for name in names]
    counted = [(m[1].lower(), int(m[2])) for m in found if m]
    if len(counted) < len(names):
        return False
    word, first = counted[0]
    return counted == [(word, first + k) for k in range(len(names))]
