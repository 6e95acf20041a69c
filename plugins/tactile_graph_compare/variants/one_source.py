"""Put all variants on one source: they see the same frames and the same truth."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from tactile_graph.api.pipeline import Pipeline
from tactile_graph.errors import PipelineError, Problem, UsageError
from tactile_graph.pipeline.graph import Source
from tactile_graph.pipeline.plain import plain
from tactile_graph_compare.variants.variants import Prepared

COUNT = "frames"
"""The setting by which a source that makes its frames is told how many."""

Given = tuple[str, dict[str, Any]]
"""A source step and what is set of it."""


def first_source(prepared: Sequence[Prepared]) -> tuple[Prepared, list[str]]:
    """Return the first variant that declares a source, and what people should know of that.

    Raises
    ------
    UsageError
        If none does.
    """
    first = next((p for p in prepared if p.pipeline.source is not None), None)
    if first is None or first.pipeline.source is None:
        raise UsageError("none of the pipelines declares a source: give recordings or --source")
    others = [p.label for p in prepared if not _same_source(p.pipeline, first.pipeline)]
    if not others:
        return first, []
    name = first.pipeline.source.name
    told = f"all run on the source of {first.label} ({name}), not on their own: "
    return first, [told + ", ".join(others)]


def given_of(source: Source) -> Given:
    """Return a source's step, and those of its settings that are not the defaults."""
    defaults = {s.name: s.default for s in source.signature.settings}
    return source.name, {k: v for k, v in source.settings.items() if v is not defaults.get(k)}


def makes_frames(pipeline: Pipeline, step: str) -> bool:
    """Return whether a source step can be told how many frames to make."""
    registry = pipeline.registry
    if registry is None or not registry.has("steps", step):
        return False
    return any(s.name == COUNT for s in registry.step(step).settings)


def on_source(prepared: Sequence[Prepared], step: str, settings: Mapping[str, Any]) -> list[
    Prepared
]:  # fmt: skip
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


def without_source(prepared: Sequence[Prepared]) -> list[Prepared]:
    """Return the variants as they are on frames handed in: with no source of their own."""
    return [replace(p, pipeline=replace(p.pipeline, source=None)) for p in prepared]


def _same_source(a: Pipeline, b: Pipeline) -> bool:
    if a.source is None or b.source is None:
        return a.source is b.source
    return a.source.name == b.source.name and plain(a.source.settings) == plain(b.source.settings)
