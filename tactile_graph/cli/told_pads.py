"""Pads that nodes are told by a file: what reads recordings is told of them, too."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tactile_graph.api.pipeline import Pipeline
    from tactile_graph.pipeline.graph import Graph

PAD = "pad"
"""The setting by which steps, and sources that read recordings, are told of a pad."""


def reads_for_told_pads(pipeline: Pipeline, beside: Sequence[Graph] = ()) -> Pipeline:
    """Return a pipeline the source of which knows the pads that its nodes are told.

    Recordings are then held against them, and one without a pitch has theirs. Pads by name stand
    in pipelines whatever is recorded, and say nothing of it.

    Parameters
    ----------
    pipeline : Pipeline
        One with a source that reads none, has no such setting, or was told a pad stays as it is.
    beside : sequence of Graph
        Others that are run on the same source.
    """
    from tactile_graph.plugins.registry import installed

    source = pipeline.source
    if source is None or not installed().has("readers", source.name):
        return pipeline
    if source.settings.get(PAD, source) is not None:  # `source`: there is no such setting
        return pipeline
    told: list[Any] = []
    for graph in (pipeline, *beside):
        told += [pad for pad in _told(graph) if pad not in told]
    return pipeline.with_source(source.name, **source.given, **{PAD: told}) if told else pipeline


def _told(graph: Graph) -> Iterator[Any]:
    for node in graph.nodes.values():
        pad = node.settings.get(PAD)
        if (isinstance(pad, str) and pad.endswith((".yaml", ".yml"))) or (
            isinstance(pad, Mapping) and "geometry" in pad
        ):
            yield pad
        if node.inner is not None:
            yield from _told(node.inner)
