"""The shipped pipelines through the command line as it is installed."""

from __future__ import annotations

import json
import subprocess
import sys

import pytest

from tactile_graph.plugins.registry import installed


def command(*args: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "tactile_graph", *args], capture_output=True, text=True, check=False
    )


@pytest.mark.slow
def test_everything_that_ships_is_right():
    got = command("check")
    assert got.returncode == 0, got.stdout
    kinds = ("pipelines", "pads", "presets", "scenes")
    assert got.stdout.count(": right") == sum(len(installed().names(k)) for k in kinds)


@pytest.mark.parametrize("name", ["circle-3", pytest.param("contacts", marks=pytest.mark.slow)])
def test_a_shipped_pipeline_runs_on_the_bundled_frames(name):
    got = command("run", name, "-o", "-")
    assert got.returncode == 0, got.stderr
    frames = [json.loads(line) for line in got.stdout.splitlines()]
    assert len(frames) > 3
    assert all(f["truth"] for f in frames)
    if name == "circle-3":
        assert max(f["errors"]["circle"]["centre_cm"] for f in frames) < 1.3
