"""The thesis family: its tables, figures and studies made again, beside its own numbers."""

from collections.abc import Mapping
from pathlib import Path

from tactile_graph import hookimpl

_STEPS = ("add_noise", "flip_cells", "jitter_points")


@hookimpl
def tactile_graph_steps() -> Mapping[str, str]:
    """Offer the steps that bring known noise between the blocks of a pipeline."""
    return {name: f"{__name__}.noise.{name}:{name}" for name in _STEPS}


@hookimpl
def tactile_graph_pipelines() -> Mapping[str, Path]:
    """Offer the thesis' ways of chapter 5 and figure 4.37, and the steps from them to others."""
    folder = Path(__file__).parent / "pipelines"
    return {path.stem: path for path in sorted(folder.glob("*.yaml"))}


@hookimpl
def tactile_graph_commands() -> Mapping[str, str]:
    """Offer the command that makes the tables, figures and studies."""
    return {"reproduce": f"{__name__}.commands.reproduce:reproduce"}
