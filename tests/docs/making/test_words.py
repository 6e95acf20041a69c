"""Words that are read are counted apart from what is looked up."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[3] / "docs"
pytestmark = pytest.mark.skipif(not DOCS.is_dir(), reason="the docs are not beside the tests")


@pytest.fixture(autouse=True)
def _beside(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "path", [str(DOCS), *sys.path])


def test_tables_and_blocks_are_not_read_but_a_glossary_is(tmp_path: Path) -> None:
    from making.words import all_words, prose_words

    page = tmp_path / "page.md"
    page.write_text("# One two\n\n| a | b |\n|---|---|\n\n```sh\nnot this\n```\n\nthree\n", "utf-8")
    assert prose_words(page) == 4
    assert all_words(page) > 4
    page.write_text("```{glossary}\nword\n  What it means.\n```\n", "utf-8")
    assert prose_words(page) == 4


def test_there_is_more_for_users_to_read_than_evidence() -> None:
    from making.words import by_kind

    pages = [p for p in DOCS.rglob("*.md") if DOCS / "catalogue" not in p.parents]
    counts = by_kind(DOCS, pages)
    assert counts["user guides"][0] > counts["evidence"][0]
