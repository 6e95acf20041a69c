"""A short run of the attacks that `benchmarks/attacks/` makes for hours."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

FOLDER = Path(__file__).parents[2] / "benchmarks" / "attacks"
pytestmark = pytest.mark.skipif(not FOLDER.is_dir(), reason="benchmarks are not beside the tests")


def attacked(script: str, *words: str) -> None:
    got = subprocess.run(
        [sys.executable, str(FOLDER / script), *words],
        capture_output=True, text=True, timeout=900, check=False,
    )  # fmt: skip
    assert got.returncode == 0, got.stdout + got.stderr


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="it forks")
def test_no_store_is_silently_wrong_or_short_and_no_kill_loses_one() -> None:
    pytest.importorskip("zarr", reason="the 'zarr' extra is not installed")
    attacked("stores.py", "--damaged", "40", "--killed", "12")


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="signals as POSIX has them")
def test_signals_leave_whole_files() -> None:
    pytest.importorskip("zarr", reason="the 'zarr' extra is not installed")
    attacked("signals.py", "--tries", "10")


@pytest.mark.slow
def test_plugins_that_misbehave_cost_only_themselves() -> None:
    attacked("plugins.py", "--mixtures", "2")


@pytest.mark.slow
def test_no_port_gives_a_misaligned_frame_as_good_and_all_lock_again() -> None:
    attacked("ports.py", "--frames", "256")
