"""Names of objects, and of the recordings their readings come from."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterable
from pathlib import PurePath


def plain_name(name: str) -> str:
    """Return a name as it is kept: white space is one blank, letters are composed (NFC)."""
    return " ".join(unicodedata.normalize("NFC", name).split())


def known_as(name: str, known: Iterable[str]) -> str | None:
    """Return the known name that is this one, or looks the same; None if there is none.

    Earlier versions kept letters as they came.
    """
    names = list(known)
    alike = (other for other in names if plain_name(other) == plain_name(name))
    return name if name in names else next(alike, None)


def recording_of(source: str) -> str:
    """Return what a reading's source says before the number of its frame."""
    return source.rpartition(" frame ")[0] or source


def is_of_recording(source: str, file: str) -> bool:
    """Return whether a reading comes from a recording.

    Parameters
    ----------
    source : str
        The file, a label if its frames have one, and the frame; or several files and, as label,
        the last parts of the one it is of.
    file : str
        As it was named when it was learned.
    """
    told, parts = recording_of(source), PurePath(file).parts
    if told == file:
        return True
    other = PurePath(told).suffix and not PurePath(file).suffix  # `press 2.csv` is none of `press`
    if told.startswith(f"{file} ") and not other:
        return True
    labels = ("/".join(parts[-n:]) for n in range(1, len(parts) + 1))
    return any(
        told.endswith(f" {label}") and f", {file}, " in f", {told.removesuffix(f' {label}')}, "
        for label in labels
    )
