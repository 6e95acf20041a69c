"""``compare``: variants side by side, from Python."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph import Image, Pipeline
from tactile_graph.errors import UsageError, shown
from tactile_graph.plugins.registry import Registry, installed
from tactile_graph.steps.injected import Report
from tactile_graph.wires.frame import Frame
from tactile_graph.wires.given import as_frames
from tactile_graph_compare.records.comparison import Comparison
from tactile_graph_compare.run.frame_choice import FrameChooser
from tactile_graph_compare.run.session import Session
from tactile_graph_compare.run.summarise import summarise
from tactile_graph_compare.variants.one_source import (
    COUNT,
    first_source,
    makes_frames,
    on_source,
    without_source,
)
from tactile_graph_compare.variants.prepare import CALLED, PreparedVariant, prepare, referred
from tactile_graph_compare.variants.request import VariantRequest, parse_request
from tactile_graph_compare.variants.sweeps import sweep_of

Given = str | Path | Pipeline | VariantRequest
READING = "source='recording', source_settings={{'path': {path!r}}}"


def compare(
    variants: Sequence[Given] | Given,
    frames: Iterable[Frame | Image | NDArray[np.generic]] | None = None,
    *,
    source: str | None = None,
    source_settings: Mapping[str, Any] | None = None,
    n_frames: int | None = None,
    settings: Mapping[str, Any] | None = None,
    sweeps: Mapping[str, Sequence[Any]] | None = None,
    crossed: bool = False,
    lineage: bool = False,
    reference: str = "",
    seed: int = 0,
    chooser: FrameChooser | None = None,
    registry: Registry | None = None,
) -> Comparison:
    """Return how variants compare on the same frames, against the same truth.

    Parameters
    ----------
    variants : sequence, or one by itself
        Pipelines by name, file or themselves, or texts as ``"NAME --set node.setting=value"``.
    frames : iterable of Frame, Image or ndarray, optional
        Instead of a source. Bare arrays are of pitch 1 cm and quantity ``raw``.
    source, source_settings : str and mapping, optional
        Source step and its settings; that of the first variant that declares one if not given.
    n_frames : int, optional
        At most so many frames.
    settings : mapping, optional
        ``node.setting`` -> value, for every pipeline that has it.
    sweeps : mapping, optional
        ``node.setting`` -> the values it takes in turn.
    crossed : bool
        Whether several sweeps are crossed instead of going side by side.
    lineage : bool
        Whether the pipelines that those named evolved from are compared too.
    reference : str
        The variant to hold all others against, by its label; without it each is held against
        what it evolved from, or the first.
    seed : int
        Of everything random: the source's frames, the steps, the resampling.
    chooser : FrameChooser, optional
        How many frames are kept whole.
    registry : Registry, optional
        The installed plugins if not given.

    Raises
    ------
    UsageError, PipelineError
        If something named does not exist or is not allowed.
    RuleError
        If a frame breaks a rule of some variant.
    """
    found = registry or installed()
    requests = [_request(v, found) for v in _each(variants)]
    if n_frames is not None:
        n_frames = _checked_count(n_frames)
    _check_named("settings", settings)
    _check_named("sweeps", sweeps)
    swept = [sweep_of(*one) for one in (sweeps or {}).items()]
    prepared = prepare(requests, found, settings, swept, crossed, lineage, CALLED)
    report, notes = Report(), list[str]()
    if frames is None:
        prepared, notes = _on_one_source(prepared, source, source_settings, n_frames)
        frames = prepared[0].pipeline.frames(seed, report)
    elif source is not None:
        raise UsageError("give frames or a source, not both")
    else:
        frames = as_frames(frames, READING)
        prepared = without_source(prepared)
    session = Session(prepared, seed, chooser, reference and referred(prepared, reference, CALLED))
    for frame in session.warmed(islice(frames, n_frames)):
        session.add(frame)
    return summarise(session, report, notes=notes)


def _on_one_source(
    prepared: list[PreparedVariant],
    source: str | None,
    settings: Mapping[str, Any] | None,
    n_frames: int | None,
) -> tuple[list[PreparedVariant], list[str]]:
    """Return the variants on the source given, or on the first's own, and what to say of it."""
    notes: list[str] = []
    given = dict(settings or {})
    if source is None:
        first, notes = first_source(prepared, "frames or source")
        assert first.pipeline.source is not None
        source, own = first.pipeline.source.name, first.pipeline.source.given
        if n_frames is not None:
            own.pop(COUNT, None)
        given = own | given
    if n_frames is not None and COUNT not in given:
        given |= {COUNT: n_frames} if makes_frames(prepared[0].pipeline, source) else {}
    return on_source(prepared, source, given), notes


def _check_named(what: str, given: Any) -> None:
    if given is not None and not isinstance(given, Mapping):
        raise UsageError(f"{what} must be a mapping of names, node.setting, got {shown(given)}")


def _checked_count(n_frames: Any) -> int:
    if isinstance(n_frames, bool) or not isinstance(n_frames, int | np.integer) or n_frames < 1:
        raise UsageError(f"n_frames: must be a whole number >= 1, got {shown(n_frames)}")
    return int(n_frames)


def _each(variants: Sequence[Given] | Given) -> Sequence[Given]:
    """Return the variants; one by itself is no sequence of letters."""
    if isinstance(variants, str | Path | Pipeline | VariantRequest):
        return [variants]
    if not isinstance(variants, Iterable):
        raise UsageError(f"variants must be a list of pipelines, got {type(variants).__name__}")
    return variants


def _request(variant: Given, registry: Registry) -> VariantRequest:
    if isinstance(variant, VariantRequest):
        return variant
    return parse_request(variant, registry) if isinstance(variant, str) else VariantRequest(variant)
