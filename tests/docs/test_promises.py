"""Every promise names a test that is there."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "promises.md"
pytestmark = pytest.mark.skipif(not PAGE.is_file(), reason="the docs are not beside the tests")


def test_every_promise_is_held_by_a_test_that_is_there() -> None:
    rows = [r for r in PAGE.read_text("utf-8").splitlines() if r.startswith("| ")]
    promises = [r for r in rows if "::" in r]
    assert len(promises) >= 30
    for row in promises:
        found = re.search(r"`(tests/\S+\.py)::(test_\w+)`", row)
        assert found is not None, row
        assert f"def {found[2]}(" in (ROOT / found[1]).read_text("utf-8"), row
