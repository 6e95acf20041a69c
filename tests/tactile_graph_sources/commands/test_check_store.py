"""``check`` looks stores through as well as pipelines, and mends them when asked to."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result

from tactile_graph import Frame
from tactile_graph.cli import cli
from tactile_graph_sources.writers.write_store import StoreWriter

pytest.importorskip("zarr", reason="the 'zarr' extra is not installed")


@pytest.fixture
def store(tmp_path: Path) -> Path:
    path = tmp_path / "a.zarr"
    with StoreWriter(path, chunk=4) as writer:
        for i in range(8):
            writer.write(Frame.of(np.full((3, 2), float(i)), quantity="volt", index=i))
    return path


def check(*args: object) -> Result:
    return CliRunner().invoke(cli, ["check", *map(str, args)])


def test_a_right_store_and_a_right_pipeline_are_told_side_by_side(store: Path) -> None:
    got = check(store, "circle-1")
    assert got.exit_code == 0, got.output
    assert f"{store}: right  8 frames of 3 x 2 cells, volt, version 3\n" in got.stdout
    assert "circle-1: right" in got.stdout


@pytest.mark.slow
def test_damage_is_named_and_mended(store: Path) -> None:
    (store / "time_s" / "zarr.json").unlink()
    got = check(store)
    assert got.exit_code == 2
    assert f"{store}: wrong  8 frames" in got.stdout
    assert "  wrong   time_s/zarr.json is damaged\n  --repair mends what can be\n" in got.stdout
    got = check(store, "--repair")
    assert got.exit_code == 0
    assert "  mended  time_s/zarr.json is damaged\n" in got.stdout


def test_what_a_full_disc_left_is_told_of_a_store_that_is_right(store: Path) -> None:
    (store / "values" / "c" / "0" / "0" / "0.abc.partial").write_bytes(b"half")
    got = check(store)
    assert got.exit_code == 0
    assert f"{store}: right  8 frames" in got.stdout
    assert "  left    1 file that a writer left unfinished\n  a writer was cut short" in got.stdout


def test_what_cannot_be_mended_stays_wrong(store: Path) -> None:
    (store / "values" / "c" / "1" / "0" / "0").unlink()
    got = check(store, "--repair")
    assert got.exit_code == 2
    told = "  wrong   frames 4 to 7: lost: values/c/1/0/0 is gone\n  this cannot be mended\n"
    assert told in got.stdout


def test_a_store_of_which_nothing_is_left_is_told(store: Path) -> None:
    (store / "frames.journal").unlink()
    (store / "zarr.json").write_text("{")
    got = check(store)
    assert got.exit_code == 2
    assert "is no Zarr store that opens" in got.stdout
    assert "Traceback" not in got.output
