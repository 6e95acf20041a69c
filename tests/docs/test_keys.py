"""docs/files.md is what docs/keys.py writes."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import pytest

from tactile_graph.plugins.registry import installed

SCRIPT = Path(__file__).parents[2] / "docs" / "keys.py"
pytestmark = pytest.mark.skipif(not SCRIPT.is_file(), reason="the docs are not beside the tests")


def test_the_page_of_all_keys_is_up_to_date() -> None:
    spec = importlib.util.spec_from_file_location("keys", SCRIPT)
    assert spec is not None
    assert spec.loader is not None
    keys = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(keys)
    written = keys.PAGE.read_text("utf-8")
    assert written == keys.page(installed()), "run python docs/keys.py"
