"""Every node of a pipeline for one reading, and step by step what a node does at once."""

from __future__ import annotations

from typing import Any

from tactile_graph import Frame, load


def stages(pipeline: str, frame: Frame, seed: int = 0) -> Any:
    """Return the result of a frame with every node of the pipeline asked for.

    Parameters
    ----------
    pipeline : str
    frame : Frame
    seed : int
    """
    loaded = load(pipeline)
    return loaded.run(frame, only=list(loaded.nodes), seed=seed)


def setting(pipeline: str, node: str, name: str) -> Any:
    """Return a setting of a node as the pipeline file, or the step's default, has it.

    Parameters
    ----------
    pipeline, node, name : str
    """
    return load(pipeline).nodes[node].settings[name]
