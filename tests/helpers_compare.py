"""The family of comparisons among the installed plugins, and a pipeline to compare with."""

from __future__ import annotations

import tactile_graph_compare

COMPARE = ("compare", "tactile-graph", "0.1.0", lambda: tactile_graph_compare)
"""Its row for `helpers_cli.install`: without it there is no command to test."""
