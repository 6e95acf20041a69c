"""The pages of kinds of files tell every key, and show every file installed."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from tactile_graph.cli.file_kinds import file_kind
from tactile_graph.plugins.registry import installed
from tactile_graph.record_schema import record_schema

DOCS = Path(__file__).parents[2] / "docs"
pytestmark = pytest.mark.skipif(not DOCS.is_dir(), reason="the docs are not beside the tests")


@pytest.mark.parametrize("kind", ["calibration", "pad", "preset", "scene"])
def test_a_page_tells_every_key_and_shows_what_is_installed(
    kind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "path", [str(DOCS), *sys.path])
    from making.file_pages import page

    text = page(installed(), kind)
    schema = record_schema(file_kind(installed(), kind), kind)
    sections = [schema.get("else", schema), *schema.get("$defs", {}).values()]
    keys = {key for section in sections for key in section.get("properties", {})}
    assert len(keys) > 10
    assert [key for key in keys if f"| `{key}` |" not in text] == []
    assert [n for n in installed().names(f"{kind}s") if f"### {n}\n" not in text] == []
