"""The mrf family: Bayesian restoration of images with line fields (thesis chapter 5)."""

from collections.abc import Mapping

from tactile_graph import hookimpl

_STEPS = {
    "gibbs": "gibbs:gibbs",
    "gnc": "gnc:gnc",
    "graph_cuts": "graph_cuts:graph_cuts",
    "icm": "icm:icm",
    "mean_field": "mean_field:mean_field",
    "posterior": "posterior:posterior",
    "restore": "restore:restore",
    "trw": "trw:trw",
}


@hookimpl
def tactile_graph_steps() -> Mapping[str, str]:
    """Offer the restorers."""
    return {name: f"{__name__}.{home}" for name, home in _STEPS.items()}
