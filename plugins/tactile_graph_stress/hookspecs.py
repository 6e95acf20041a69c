"""The hook of the stress test: what else steps are stressed with."""

from __future__ import annotations

from collections.abc import Mapping

from tactile_graph.plugins.hookspecs import hook_of


@hook_of("tactile_graph_stress.cases.stress_cases:StressCases")
def tactile_graph_stress_cases() -> Mapping[str, str]:  # type: ignore[empty-body]
    """Set of cases -> import string of its `StressCases`, which ``stress`` tries steps on."""
