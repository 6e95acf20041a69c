"""Pad files as ``check`` and ``schema`` take them."""

from __future__ import annotations

from tactile_graph.plugins.file_kind import FileKind
from tactile_graph_pads.pad import Pad, load_pad


def read_pad(pad: str) -> Pad:
    """Return a pad with the table of its elements read too, where it has one.

    Raises
    ------
    UsageError, RecordError
        As `load_pad` does.
    DataError
        If the table is not there, or not a table of this pad.
    """
    found = load_pad(pad)
    if found.learned is not None:
        _ = found.learned.table
    return found


def tell_pad(pad: Pad) -> str:
    """Return what a pad is, in a line."""
    geometry, bits = pad.geometry, pad.converter.bits
    words = [
        f"{geometry.rows} x {geometry.columns} elements, {geometry.pitch_cm:g} cm apart",
        f"{pad.circuit.kind} of {pad.circuit.bias_ohm:g} ohm",
        f"{bits} bits" if bits else "an ideal converter",
    ]
    if pad.learned is not None:
        words.append(f"learned from recordings in {pad.learned.reading}")
    return "; ".join(words)


PAD = FileKind("pads", Pad, read_pad, tell_pad)
