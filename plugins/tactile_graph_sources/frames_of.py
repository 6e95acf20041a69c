"""Frames of a recording, whether a Zarr store or a file of any known format."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from tactile_graph.steps.injected import Report
from tactile_graph.wires.frame import Frame


def frames_of(path: str | Path, report: Report, **told: Any) -> Iterator[Frame]:
    """Return the frames of a Zarr store or of a file that the source ``recording`` reads.

    Parameters
    ----------
    path : path
    report : Report
    **told
        What ``recording`` is to be told about a file: rows, columns, pitch, quantity.
    """
    from tactile_graph_sources.recording import recording
    from tactile_graph_sources.store import is_store, read_store

    if is_store(path):
        return read_store(path, report)
    return recording(path=Path(path), report=report, **told)
