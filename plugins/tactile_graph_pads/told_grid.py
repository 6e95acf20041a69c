"""``ToldGrid``: what a pad file says of its elements' number and distance, beside recordings."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from tactile_graph_pads.pad import Pad, path_of, read_file
from tactile_graph_pads.records import inline, read_record

CLOSE = 0.01
"""Share by which a pitch may differ from another and still be the same in round numbers."""


class ToldGrid(NamedTuple):
    """The grid that a pad was said to have; None for what nobody said, where a default stands.

    Attributes
    ----------
    name : str
        The pad, for people.
    shape : tuple of int, optional
        Rows and columns.
    pitch_cm : float, optional
    """

    name: str
    shape: tuple[int, int] | None = None
    pitch_cm: float | None = None

    def pitch_of(self, shape: tuple[int, int]) -> float | None:
        """Return the pitch of recordings of that shape; None where it is not this pad's."""
        return self.pitch_cm if self.shape == shape else None

    def misfit(self, shape: tuple[int, int], pitch_cm: tuple[float, float] | None) -> str:
        """Return what to say of cells that cannot be of this pad; empty where they may be."""
        fits = self.shape in (None, shape)
        if fits and (self.pitch_cm is None or pitch_cm is None or close(self.pitch_cm, pitch_cm)):
            return ""
        own = None if self.pitch_cm is None else (self.pitch_cm, self.pitch_cm)
        here, there = _words(shape, pitch_cm), _words(self.shape, own)
        return f"cells, {here}, are not those of {self.name}, {there}"


def close(pitch_cm: float, of_image_cm: tuple[float, float]) -> bool:
    """Return whether a pad's pitch is an image's; between its two where these differ."""
    low, high = min(of_image_cm), max(of_image_cm)
    return (1 - CLOSE) * low <= pitch_cm <= (1 + CLOSE) * high


def _words(shape: tuple[int, int] | None, pitch_cm: tuple[float, float] | None) -> str:
    words = [] if shape is None else [f"{shape[0]} x {shape[1]}"]
    if pitch_cm is not None:
        words.append(" x ".join(f"{p:g}" for p in dict.fromkeys(pitch_cm)) + " cm apart")
    return " and ".join(words)


def told_grid(pad: str | Path | Mapping[str, Any]) -> ToldGrid:
    """Return what a pad's file, or the pad itself, says of its grid.

    Parameters
    ----------
    pad : str, Path or mapping
        As `pad.load_pad` takes it.

    Raises
    ------
    UsageError, RecordError
        As `pad.load_pad` does.
    """
    if isinstance(pad, Mapping):
        name, document = "the told pad", inline(pad, "pad")
    else:
        name, document = f"pad {pad}", read_file(path_of(pad), "pad")
    geometry, said = read_record(document, Pad, "a pad").geometry, document.data.get("geometry", {})
    return ToldGrid(
        name,
        geometry.shape if {"rows", "columns"} <= said.keys() else None,
        geometry.pitch_cm if "element_cm" in said else None,
    )
