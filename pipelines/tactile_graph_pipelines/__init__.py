"""The shipped pipelines: every YAML file of this folder, named as the file is."""

from collections.abc import Mapping
from pathlib import Path

from tactile_graph import hookimpl


@hookimpl
def tactile_graph_pipelines() -> Mapping[str, Path]:
    """Offer each YAML file here under its own name."""
    return {path.stem: path for path in sorted(Path(__file__).parent.glob("*.yaml"))}
