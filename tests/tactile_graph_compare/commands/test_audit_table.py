"""What stands below the tables of an audit."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

from tactile_graph_compare.commands.audit import error_table


def test_it_says_where_errors_have_no_bounds():
    found: Any = SimpleNamespace(guards=())
    assert error_table(found).note.endswith("; no bounds where fewer than six frames differ")
