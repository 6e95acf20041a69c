"""The ``recording`` source opens a Zarr store as it opens a file."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from helpers_recordings import frames_of
from tactile_graph import Frame, load
from tactile_graph.errors import DataError

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


def test_what_is_told_of_a_store_counts_as_it_does_for_any_file(tmp_path: Path) -> None:
    from tactile_graph_sources.writers.write_store import StoreWriter

    store, values = tmp_path / "a.zarr", np.arange(6.0).reshape(2, 3)
    with StoreWriter(store) as writer:
        writer.write(Frame.of(values, 1.0, quantity="raw", index=0, label="left"))
    found, report = frames_of(store, pitch_cm=0.5, quantity="counts", transpose=True)
    assert found[0].image.pitch_cm == (0.5, 0.5)
    assert found[0].image.quantity == "counts"
    np.testing.assert_array_equal(found[0].image.values, values.T)
    assert report.counts["recordings read as Zarr store of ours"] == 1
    with pytest.raises(DataError, match="no sensor 'right', there are: left"):
        frames_of(store, sensor="right")
    with pytest.raises(DataError, match="its frames have 2 rows and 3 columns, the settings say"):
        frames_of(store, rows=5, columns=3)
