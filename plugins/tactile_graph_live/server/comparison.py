"""What is left of a variant that ran beside: figures, and the frames that tell it apart."""

from __future__ import annotations

import json
from collections.abc import Iterator
from datetime import datetime
from pathlib import Path

from tactile_graph.errors import UsageError
from tactile_graph.files import write_whole
from tactile_graph.inspect import as_data, without_nan
from tactile_graph_live.bench.wire import Compared
from tactile_graph_live.server.recorder import free_name


def words_of(compared: Compared) -> str:
    """Return in a line how far the two agree, and what each takes."""
    its = compared.summary
    if its["trouble"] or not its["frames"]:
        return f"{its['variant']} beside: {its['trouble'] or 'no frame was answered'}"
    return (
        f"{its['variant']} beside: {its['same_outcomes']} of {its['frames']} frames with the same "
        f"outcomes, median {its['beside_median_us']:.0f} µs against {its['median_us']:.0f} µs"
    )


def write_comparison(folder: Path, compared: Compared) -> Iterator[Path]:
    """Write the figures as JSON, and the frames on which the two differ most as a Zarr store.

    The store is left out where there are no such frames, and where stores cannot be written.

    Yields
    ------
    Path
        Of each file, once it is written.
    """
    store = free_name(folder, f"beside-{compared.summary['variant']}", datetime.now())
    figures = {**compared.summary, "kept": list(compared.said)}
    path = store.with_suffix(".json")
    write_whole(path, json.dumps(without_nan(as_data(figures)), indent=1) + "\n")
    yield path
    if not compared.frames:
        return
    from tactile_graph_sources.writers.write_store import StoreWriter

    try:
        with StoreWriter(store, about={"port": "frames that differ most"}) as writer:
            for frame in sorted(compared.frames, key=lambda f: f.index):
                writer.write(frame)
    except UsageError:  # without Zarr, the figures still name the frames
        return
    yield store
