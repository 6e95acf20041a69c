"""Fingers on a pad: forces in newtons, recordings, and strokes put to points."""

from collections.abc import Mapping
from pathlib import Path

from tactile_graph import hookimpl

_STEPS = {
    "fit_stroke": "fit_stroke:fit_stroke",
    "newtons": "newtons:newtons",
    "strokes": "strokes:strokes",
}


@hookimpl
def tactile_graph_steps() -> Mapping[str, str]:
    """Offer forces, strokes to try, and the fit of strokes."""
    return {name: f"tactile_graph_fingers.{home}" for name, home in _STEPS.items()}


@hookimpl
def tactile_graph_quantities() -> Mapping[str, str]:
    """Offer forces."""
    return {"newton": "N"}


@hookimpl
def tactile_graph_recording_formats() -> Mapping[str, str]:
    """Read what fingers are recorded in."""
    return {"fingers": "tactile_graph_fingers.recording:FINGERS"}


@hookimpl
def tactile_graph_report_sections() -> Mapping[str, str]:
    """Tell how long the strokes were."""
    return {"strokes": "tactile_graph_fingers.report:STROKES"}


@hookimpl
def tactile_graph_pipelines() -> Mapping[str, Path]:
    """Offer a stroke put to every frame."""
    folder = Path(__file__).parent / "pipelines"
    return {p.stem: p for p in sorted(folder.glob("*.yaml"))}
