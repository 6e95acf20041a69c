"""Two pipelines by name, and not one step: a pipeline within another, conditions over items.

Run by:
    tactile-graph run discs-of-several --frames 3
    tactile-graph explain discs-of-several --frame 1
"""

from collections.abc import Mapping
from pathlib import Path

from tactile_graph import hookimpl

FOLDER = Path(__file__).parent / "pipelines"


@hookimpl
def tactile_graph_pipelines() -> Mapping[str, Path]:
    """Offer the disc of one contact, and the discs of all where there are several."""
    names = ("disc-of-contact", "discs-of-several")
    return {name: FOLDER / f"{name}.yaml" for name in names}
