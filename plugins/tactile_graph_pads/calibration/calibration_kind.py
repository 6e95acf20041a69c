"""Calibration files as ``check`` and ``schema`` take them."""

from __future__ import annotations

from tactile_graph.plugins.file_kind import FileKind
from tactile_graph_pads.calibration.calibration import UNITS, Calibration, load_calibration


def tell_calibration(made: Calibration) -> str:
    """Return what a calibration turns into grams, in a line."""
    n = len(made.points)
    words = [
        f"{made.fit.kind} curve of {n} loads, {made.reading} from {made.from_reading:.4g} to "
        f"{made.up_to:.4g} {UNITS[made.reading]}",
        f"off by {made.quality.rms_percent:.1f} % (rms)",
    ]
    if made.offset:
        rows, columns = len(made.offset), len(made.offset[0])
        words.append(f"above what an empty pad of {rows} x {columns} elements reads")
    return "; ".join(words)


CALIBRATION = FileKind("", Calibration, load_calibration, tell_calibration)
