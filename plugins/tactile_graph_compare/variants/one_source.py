"""Put all variants on one source: they see the same frames and the same truth."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from tactile_graph import Pipeline
from tactile_graph.errors import PipelineError, Problem, UsageError
from tactile_graph.inspect import plain
from tactile_graph_compare.variants.prepare import PreparedVariant

COUNT = "frames"
"""The setting by which a source that makes its frames is told how many."""


def first_source(
    prepared: Sequence[PreparedVariant], remedy: str = "recordings or --source"
) -> tuple[PreparedVariant, list[str]]:
    """Return the first variant that declares a source, and what people should know of that.

    Parameters
    ----------
    prepared : sequence of PreparedVariant
    remedy : str
        What to give where none does.

    Raises
    ------
    UsageError
        If none does.
    """
    first = next((p for p in prepared if p.pipeline.source is not None), None)
    if first is None or first.pipeline.source is None:
        raise UsageError(f"none of the pipelines declares a source: give {remedy}")
    others = [p.label for p in prepared if not _same_source(p.pipeline, first.pipeline)]
    if not others:
        return first, []
    name = first.pipeline.source.name
    told = f"all run on the source of {first.label} ({name}), not on their own: "
    return first, [told + ", ".join(others)]


def makes_frames(pipeline: Pipeline, step: str) -> bool:
    """Return whether a source step can be told how many frames to make."""
    registry = pipeline.registry
    if registry is None or not registry.has("steps", step):
        return False
    return any(s.name == COUNT for s in registry.step(step).settings)


def on_source(
    prepared: Sequence[PreparedVariant], step: str, settings: Mapping[str, Any]
) -> list[PreparedVariant]:
    """Return the variants on a source.

    Raises
    ------
    PipelineError
        If a variant cannot take its frames, or the source its settings.
    """
    placed = []
    for one in prepared:
        try:
            pipeline = one.pipeline.with_source(step, **settings)
        except PipelineError as error:
            problems = [
                Problem(p.mark, f"variant {one.label}, on source {step!r}: {p.message}", p.snippet)
                for p in error.problems
            ]
            raise PipelineError(problems) from None
        placed.append(replace(one, pipeline=pipeline))
    return placed


def without_source(prepared: Sequence[PreparedVariant]) -> list[PreparedVariant]:
    """Return the variants as they are on frames handed in: with no source of their own."""
    return [replace(p, pipeline=replace(p.pipeline, source=None)) for p in prepared]


def _same_source(a: Pipeline, b: Pipeline) -> bool:
    if a.source is None or b.source is None:
        return a.source is b.source
    return a.source.name == b.source.name and plain(a.source.settings) == plain(b.source.settings)
