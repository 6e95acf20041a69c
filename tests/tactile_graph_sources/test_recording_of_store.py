"""The ``recording`` source opens a Zarr store as it opens a file."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tactile_graph import Frame, load

pytest.importorskip("zarr", reason="the zarr extra is not installed")


def test_a_store_runs_through_a_pipeline_and_is_numbered_on(tmp_path: Path) -> None:
    from tactile_graph_sources.writers.write_store import StoreWriter

    frames = list(load("circle-3").frames())
    store = tmp_path / "discs.zarr"
    with StoreWriter(store) as writer:
        for frame in frames:
            writer.write(frame)
    pipeline = load("circle-3").with_source("recording", path=[str(store), str(store)])
    results = list(pipeline.stream())
    assert [r.frame.index for r in results] == list(range(12))
    expected = [r["circle"] for r in load("circle-3").stream(frames)]
    assert [r["circle"] for r in results] == expected * 2
    assert np.array_equal(results[0].frame.image.values, frames[0].image.values)
    assert isinstance(results[0].frame, Frame)
