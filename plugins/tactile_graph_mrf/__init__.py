"""The mrf family: Bayesian restoration of images with line fields (thesis chapter 5)."""

from collections.abc import Mapping

from tactile_graph import hookimpl

_STEPS = {
    "close_lines": "contours.close_lines:close_lines",
    "compress": "compress:compress",
    "contours": "contours.contours:contours",
    "expect": "expect:expect",
    "gibbs": "samplers.gibbs:gibbs",
    "gnc": "descent.gnc:gnc",
    "graph_cuts": "descent.graph_cuts:graph_cuts",
    "icm": "descent.icm:icm",
    "line_contacts": "contours.line_contacts:LineContacts",
    "line_regions": "contours.line_regions:line_regions",
    "mean_field": "descent.mean_field:mean_field",
    "near_hull": "contours.near_hull:near_hull",
    "outline_points": "contours.outline_points:outline_points",
    "posterior": "samplers.posterior:posterior",
    "restore": "descent.restore:restore",
    "trw": "descent.trw:trw",
}


@hookimpl
def tactile_graph_steps() -> Mapping[str, str]:
    """Offer the restorers."""
    return {name: f"{__name__}.{home}" for name, home in _STEPS.items()}
