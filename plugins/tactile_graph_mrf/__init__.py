"""The mrf family: Bayesian restoration of images with line fields (thesis chapter 5)."""

from collections.abc import Mapping

from tactile_graph import hookimpl

_STEPS = {
    "close_lines": "close_lines:close_lines",
    "compress": "compress:compress",
    "contours": "contours:contours",
    "expect": "expect:expect",
    "gibbs": "gibbs:gibbs",
    "gnc": "gnc:gnc",
    "graph_cuts": "graph_cuts:graph_cuts",
    "icm": "icm:icm",
    "line_contacts": "line_contacts:LineContacts",
    "line_regions": "line_regions:line_regions",
    "mean_field": "mean_field:mean_field",
    "near_hull": "near_hull:near_hull",
    "outline_points": "outline_points:outline_points",
    "posterior": "posterior:posterior",
    "restore": "restore:restore",
    "trw": "trw:trw",
}


@hookimpl
def tactile_graph_steps() -> Mapping[str, str]:
    """Offer the restorers."""
    return {name: f"{__name__}.{home}" for name, home in _STEPS.items()}
