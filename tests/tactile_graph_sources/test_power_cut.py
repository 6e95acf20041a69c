"""After a power cut a store holds what its writer had waited for, and nothing else may matter."""

from __future__ import annotations

import os
import shutil
import sys
from pathlib import Path

import numpy as np
import pytest

from tactile_graph import Frame
from tactile_graph.steps import Report

pytest.importorskip("zarr", reason="the 'zarr' extra is not installed")

from tactile_graph_sources.store import read_store
from tactile_graph_sources.writers.write_store import StoreWriter

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="looks up what a descriptor is of")


@pytest.mark.slow
@pytest.mark.parametrize(("n_waiting", "told"), [(0, [4, 8, 10]), (6, [4, 10])])
def test_blocks_are_on_the_disc_before_the_journal_vouches_for_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, n_waiting: int, told: list[int]
) -> None:
    store, disc = tmp_path / "a.zarr", tmp_path / "disc"
    kept: list[int] = []
    fsync = os.fsync

    def synced(descriptor: int) -> None:
        """Copy the file to where only what was waited for is, and read the store there."""
        fsync(descriptor)
        path = Path(os.readlink(f"/proc/self/fd/{descriptor}"))
        root = next((p for p in (path, *path.parents) if "a.zarr" in p.name), None)
        if path.is_file() and root is not None:
            copy = disc / path.relative_to(root)
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(path, copy)
            if path.name == "frames.journal" and path.read_bytes().count(b"\n") > 1:
                kept.append(sum(1 for _ in read_store(disc, Report())))

    monkeypatch.setattr(os, "fsync", synced)
    frames = [Frame.of(np.full((3, 4), float(i)), index=i, time_s=0.1 * i) for i in range(10)]
    with StoreWriter(store, chunk=4) as writer:
        writer.n_waiting = n_waiting
        for frame in frames:
            writer.write(frame)
    assert kept == told
    left = list(read_store(disc, Report()))
    assert [f.image.values[0, 0] for f in left] == [float(i) for i in range(10)]
    assert [f.time_s for f in left] == [f.time_s for f in frames]
    assert not any(f.doubtful or f.gap for f in left)
