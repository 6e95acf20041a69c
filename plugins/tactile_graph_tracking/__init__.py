"""The tracking family: objects followed from frame to frame, and scored against the truth."""

from collections.abc import Mapping

from tactile_graph import hookimpl

_STEPS = {
    "score_objects": "score_objects:score_objects",
    "track": "track:Track",
}


@hookimpl
def tactile_graph_steps() -> Mapping[str, str]:
    """Offer the steps about objects over time."""
    return {name: f"{__name__}.{home}" for name, home in _STEPS.items()}
