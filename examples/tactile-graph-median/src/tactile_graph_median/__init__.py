"""A median filter for tactile-graph, and a pipeline that uses it."""

from collections.abc import Mapping
from pathlib import Path

from tactile_graph import hookimpl


@hookimpl
def tactile_graph_steps() -> Mapping[str, str]:
    """Offer the median; its module is imported when a pipeline uses it."""
    return {"median": "tactile_graph_median.median:median"}


@hookimpl
def tactile_graph_pipelines() -> Mapping[str, Path]:
    """Offer the pipeline."""
    return {"steady-contacts": Path(__file__).parent / "pipelines" / "steady-contacts.yaml"}
