"""What tells versions of one number apart: any change of the project's code, or of its plugins."""

from __future__ import annotations

import re
from importlib.metadata import version
from pathlib import Path
from types import SimpleNamespace

import pytest

from tactile_graph import code_version as module
from tactile_graph.code_version import code_version


@pytest.fixture
def code(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a file of a plugin's code, where all other packages are empty."""
    place = tmp_path / "tactile_graph_pads" / "deep" / "a.py"
    place.parent.mkdir(parents=True)
    place.write_text("n = 1\n")

    def found(name: str) -> SimpleNamespace:
        return SimpleNamespace(submodule_search_locations=[str(tmp_path / name)])

    monkeypatch.setattr(module, "find_spec", found)
    return place


def test_the_digest_stands_behind_the_version() -> None:
    told = rf"{re.escape(version('tactile-graph'))} \(code [0-9a-f]{{12}}\)"
    assert re.fullmatch(told, code_version())
    assert code_version() == code_version()


def test_other_code_has_another_digest(code: Path) -> None:
    before = code_version()
    (code.parent / "notes.txt").write_text("no code")
    assert code_version() == before
    code.write_text("n = 2\n")
    changed = code_version()
    assert changed != before
    code.rename(code.with_name("b.py"))
    assert code_version() not in (before, changed)


def test_a_package_that_is_not_there_is_passed_over(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "find_spec", lambda _: None)
    assert code_version().startswith(f"{version('tactile-graph')} (code ")
