"""The order of files by the numbers in their names, in which 10 comes after 9."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from pathlib import Path

_NUMBER = re.compile(r"(\d+)")


def in_order(names: Iterable[str]) -> list[str]:
    """Return names by the numbers in them."""
    return sorted(names, key=lambda n: [(p.isdecimal(), p.zfill(20)) for p in _NUMBER.split(n)])


def are_numbered(names: Sequence[str]) -> bool:
    """Return whether several names differ in numbers alone: ``f0.csv``, ``f1.csv``, …."""
    return len(names) > 1 and len({_NUMBER.sub("#", name) for name in names}) == 1


def out_of_order(paths: Iterable[Path]) -> tuple[Path, Path] | None:
    """Return a file and one before it whose number is larger, of files named alike; None if none.

    As a shell sorts them ``f10.csv`` comes before ``f2.csv``.
    """
    last: dict[tuple[Path, str], Path] = {}
    for path in paths:
        kind = path.parent, _NUMBER.sub("#", path.name)
        before = last.get(kind, path)
        if in_order([path.name, before.name])[0] != before.name:
            return path, before
        last[kind] = path
    return None
