"""The hand-made plugin and the family itself stand in for the installed ones."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

import tactile_graph_tune
from helpers_cli import install
from helpers_compare import COMPARE
from helpers_tune import LADDER
from tactile_graph.plugins import registry

TUNE = ("tune", "tactile-graph", "0.1.0", lambda: tactile_graph_tune)


@pytest.fixture
def hand_made(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A folder with ``ladder.yaml``."""
    install(monkeypatch, tmp_path, COMPARE, TUNE)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "ladder.yaml").write_text(LADDER)
    monkeypatch.setattr("tactile_graph.compiled.warm_up", lambda: None)
    yield tmp_path
    registry.installed.cache_clear()
