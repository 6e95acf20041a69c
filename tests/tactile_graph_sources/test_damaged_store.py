"""A store that lost a part is read as far as it goes, and says what is gone."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest

from tactile_graph import Frame
from tactile_graph.errors import DataError
from tactile_graph.steps import Report
from tactile_graph_sources.store import read_store
from tactile_graph_sources.writers.write_store import StoreWriter

pytest.importorskip("zarr", reason="the 'zarr' extra is not installed")


@pytest.fixture
def store(tmp_path: Path) -> Path:
    path = tmp_path / "a.zarr"
    rng = np.random.default_rng(0)
    with StoreWriter(path, chunk=4) as writer:
        for i in range(10):
            writer.write(Frame.of(rng.random((3, 2)), quantity="volt", index=i, time_s=0.1 * i))
    return path


def test_a_damaged_chunk_is_left_out_counted_and_followed_by_a_gap(store: Path) -> None:
    part = store / "values" / "c" / "1" / "0" / "0"
    part.write_bytes(part.read_bytes()[:10])
    report = Report()
    frames = list(read_store(store, report))
    assert [f.index for f in frames] == [0, 1, 2, 3, 8, 9]
    assert [f.index for f in frames if f.gap] == [8]
    assert report.counts["damaged records skipped"] == 4
    assert report.troubles[0][0] == str(store)
    assert report.troubles[0][1].startswith("frames 4 to 7 cannot be read: ")


def test_a_chunk_that_is_gone_is_doubted_and_its_cells_are_invalid(store: Path) -> None:
    shutil.rmtree(store / "values" / "c" / "1")
    report = Report()
    frames = list(read_store(store, report))
    assert len(frames) == 10
    assert not np.any(frames[5].image.valid)
    told = "frames 4 to 7 hold no valid cell: is a part of the store missing?"
    assert report.troubles == [(str(store), told)]


def test_a_store_of_which_nothing_can_be_read_is_an_error(store: Path) -> None:
    for part in (store / "values" / "c").rglob("*"):
        if part.is_file():
            part.write_bytes(b"junk")
    with pytest.raises(DataError, match=r"a\.zarr: not a single frame of it can be read"):
        list(read_store(store))
    (store / "number" / "c" / "0").write_bytes(b"junk")
    with pytest.raises(DataError, match=r"a\.zarr: its frame numbers cannot be read: "):
        list(read_store(store))
