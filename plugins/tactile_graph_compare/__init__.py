"""Variants of pipelines side by side: `compare`, and the commands ``compare`` and ``audit``."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from tactile_graph import hookimpl
from tactile_graph_compare import hookspecs as hookspecs

if TYPE_CHECKING:
    from tactile_graph_compare.records.comparison import Comparison as Comparison
    from tactile_graph_compare.run.compare import compare as compare
    from tactile_graph_compare.variants.request import VariantRequest as VariantRequest

# Name -> module, loaded on first use: listing the plugins must stay quick.
_HOMES = {
    "Comparison": "records.comparison",
    "VariantRequest": "variants.request",
    "compare": "run.compare",
}
__all__ = ["Comparison", "VariantRequest", "compare"]
# In the order of the page.
_SECTIONS = (
    "summary", "graph", "pareto", "errors", "differences", "agreement", "times", "lineage",
    "frames", "timeline", "making",
)  # fmt: skip


@hookimpl
def tactile_graph_commands() -> Mapping[str, str]:
    """Offer the commands that compare variants, and that tell what each guard is worth."""
    return {name: f"{__name__}.commands.{name}:{name}" for name in ("audit", "compare")}


@hookimpl
def tactile_graph_report_sections() -> Mapping[str, str]:
    """Offer the sections of the report."""
    return {name: f"{__name__}.report.sections:{name.upper()}" for name in _SECTIONS}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from importlib import import_module

    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
