"""The hand-made plugin stands in for the installed ones."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from helpers_cli import install
from tactile_graph.plugins import registry


@pytest.fixture
def hand_made(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    install(monkeypatch, tmp_path)
    monkeypatch.chdir(tmp_path)
    # It would compile the kernels for every test that comes after.
    monkeypatch.setattr("tactile_graph.compiled.warm_up", lambda: None)
    yield tmp_path
    registry.installed.cache_clear()
