"""All pages of the site that are made when it is built; none of them is kept in the repository."""

from __future__ import annotations

import os
from pathlib import Path

DOCS = Path(__file__).parents[1]
INTO = DOCS / "catalogue"
KEPT = Path(os.environ.get("TACTILE_GRAPH_SITE_CACHE", DOCS.parent / ".site_cache"))


def generate(into: Path = INTO, kept: Path = KEPT) -> str:
    """Write the catalogue, and return in a line what was made."""
    os.environ.setdefault("TACTILE_GRAPH_KERNELS", "compiled")  # costs are those of a long run
    from making.command_pages import write_commands
    from making.file_pages import write_files
    from making.pipeline_pages import write_pipelines
    from making.step_pages import write_steps
    from making.tutorial_pictures import write_pictures
    from tactile_graph.plugins.registry import installed

    registry = installed()
    n_steps = write_steps(registry, into / "steps", kept)
    n_pipelines = write_pipelines(registry, into, kept)
    n_commands = write_commands(into)
    n_files = write_files(registry, into)
    n_pictures = write_pictures(into, kept)
    return (
        f"{n_steps} steps, {n_pipelines} pipelines, {n_commands} commands, {n_files} kinds of "
        f"files, {n_pictures} pictures of the tutorial"
    )
