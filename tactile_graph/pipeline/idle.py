"""Settings that change nothing: what is asked of a pipeline does not need their node."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from tactile_graph.pipeline.graph import Graph


def idle_settings(pipeline: Graph, names: Iterable[str], asked: Sequence[str] = ()) -> list[str]:
    """Return which settings change nothing.

    Parameters
    ----------
    pipeline : Graph
    names : iterable of str
        Settings that it has, as ``node.setting``.
    asked : sequence of str, optional
        What is asked of it; its outputs if nothing is.
    """
    refs = [pipeline.outputs.get(name) or pipeline.ref(name) for name in asked]
    needed = pipeline.needed(refs or pipeline.outputs.values())
    maps = {name for name in needed if pipeline.nodes[name].inner is not None}
    return [n for n in names if not ({n.rpartition(".")[0]} & needed or {*_outer(n)} & maps)]


def _outer(name: str) -> Iterable[str]:
    """Yield the nodes that a setting's node lies within."""
    parts = name.split("/")
    return ("/".join(parts[:i]) for i in range(1, len(parts)))
