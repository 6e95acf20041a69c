"""The hand-made plugin and the family itself stand in for the installed ones."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from helpers_cli import install
from helpers_compare import COMPARE
from tactile_graph.plugins import registry

NEXT = """\
pipeline: next
about: Discs with a spare circle where the first finds none, and another level
evolves: discs
source: {step: made, with: {frames: 4}}
conditions:
  touched: footprint.count > 0
nodes:
  footprint: {step: pressed, in: frame, with: {level_v: 0.5}}
  merged: {step: merge, in: [footprint]}
  first: {step: disc, in: merged, with: {fail_at_x: 1}, when: touched}
  spare: {step: disc, in: footprint, when: touched}
  circle: {first_of: [first, spare]}
outputs: [circle]
"""


@pytest.fixture(autouse=True)
def quiet(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """A machine on which nothing is said of other programs."""
    monkeypatch.setattr("tactile_graph_compare.run.crowded.SCHEDULED", tmp_path / "none")


@pytest.fixture
def hand_made(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A folder with ``next.yaml``, which evolves from the plugin's ``discs``."""
    install(monkeypatch, tmp_path, COMPARE)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "next.yaml").write_text(NEXT)
    # It would compile the kernels for every test that comes after.
    monkeypatch.setattr("tactile_graph.compiled.warm_up", lambda: None)
    yield tmp_path
    registry.installed.cache_clear()
