"""A short run of the attacks that `benchmarks/attacks/` makes for hours."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

FOLDER = Path(__file__).parents[2] / "benchmarks" / "attacks"
pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not FOLDER.is_dir(), reason="benchmarks are not beside the tests"),
    pytest.mark.skipif(sys.platform == "win32", reason="they fork, and send POSIX's signals"),
]


def attacked(script: str, *words: str) -> None:
    got = subprocess.run(
        [sys.executable, str(FOLDER / script), *words],
        capture_output=True, text=True, timeout=900, check=False,
    )  # fmt: skip
    assert got.returncode == 0, got.stdout + got.stderr


def test_no_store_is_silently_wrong_or_short_and_no_kill_loses_one() -> None:
    pytest.importorskip("zarr", reason="the 'zarr' extra is not installed")
    attacked("stores.py", "--tries", "24", "--killed", "6")


def test_signals_leave_whole_files() -> None:
    pytest.importorskip("zarr", reason="the 'zarr' extra is not installed")
    attacked("signals.py", "--tries", "4")


def test_killed_commands_leave_whole_files() -> None:
    pytest.importorskip("zarr", reason="the 'zarr' extra is not installed")
    attacked("kills.py", "--tries", "4", "--only", "learn", "import", "calibrate", "images")


def test_interrupted_workers_end_soon_and_leave_nothing() -> None:
    attacked("interrupts.py", "--tries", "4", "--seed", "11", "--latest", "3")


def test_plugins_that_misbehave_cost_only_themselves() -> None:
    attacked("plugins.py", "--tries", "12", "--forks")


def test_no_port_gives_a_misaligned_frame_as_good_and_all_lock_again() -> None:
    attacked("ports.py", "--frames", "128")


def test_replies_that_pause_or_are_hurt_tear_no_frame_that_is_given_as_good() -> None:
    attacked("replies.py", "--seconds", "4")


def test_damaged_databases_are_refused_or_read_as_they_were() -> None:
    attacked("databases.py", "--tries", "300")


def test_damaged_pipelines_pads_presets_and_scenes_are_refused_in_words() -> None:
    attacked("pipelines.py", "--tries", "200")


@pytest.mark.skipif(sys.platform != "linux", reason="measures memory as Linux tells it")
def test_files_that_ask_for_too_much_are_refused_before_the_work() -> None:
    attacked("files.py", "--tries", "8")


def test_hostile_frames_are_answered_or_refused() -> None:
    attacked("frames.py", "--tries", "48", "--pipelines", "circle-1", "circle-3", "rectangle-3")


@pytest.mark.skipif(sys.platform != "linux", reason="looks for processes where Linux tells them")
def test_killed_runs_with_workers_are_resumed_to_the_same_file() -> None:
    pytest.importorskip("zarr", reason="the 'zarr' extra is not installed")
    attacked("workers.py", "--tries", "2", "--kills", "2", "--frames", "2000", "--nice", "0")
