"""``compare``: variants side by side, from Python."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import chain, islice
from pathlib import Path
from typing import Any

from tactile_graph.api.pipeline import Pipeline
from tactile_graph.errors import UsageError
from tactile_graph.plugins.registry import Registry, installed
from tactile_graph.steps.injected import Report
from tactile_graph.wires.frame import Frame
from tactile_graph_compare.records.comparison import Comparison
from tactile_graph_compare.run.frame_choice import Keeper
from tactile_graph_compare.run.session import WARM_FRAMES, Session
from tactile_graph_compare.run.summarise import close
from tactile_graph_compare.variants.one_source import (
    COUNT,
    first_source,
    given_of,
    makes_frames,
    on_source,
    without_source,
)
from tactile_graph_compare.variants.request import Wanted, parse_wanted
from tactile_graph_compare.variants.sweeps import Sweep
from tactile_graph_compare.variants.variants import Prepared, prepare


def compare(
    variants: Sequence[str | Path | Pipeline | Wanted],
    frames: Iterable[Frame] | None = None,
    *,
    source: str | None = None,
    source_settings: Mapping[str, Any] | None = None,
    n_frames: int | None = None,
    settings: Mapping[str, Any] | None = None,
    sweeps: Mapping[str, Sequence[Any]] | None = None,
    crossed: bool = False,
    lineage: bool = False,
    seed: int = 0,
    keeper: Keeper | None = None,
    registry: Registry | None = None,
) -> Comparison:
    """Return how variants compare on the same frames, against the same truth.

    Parameters
    ----------
    variants : sequence
        Pipelines by name, file or themselves, or texts as ``"NAME --set node.setting=value"``.
    frames : iterable of Frame, optional
        Instead of a source.
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
    seed : int
        Of everything random: the source's frames, the steps, the resampling.
    keeper : Keeper, optional
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
    wanted = [_wanted(v, found) for v in variants]
    swept = [Sweep(name, tuple(values)) for name, values in (sweeps or {}).items()]
    prepared = prepare(wanted, found, settings, swept, crossed, lineage)
    report, notes = Report(), list[str]()
    if frames is None:
        prepared, notes = _on_one_source(prepared, source, source_settings, n_frames)
        frames = prepared[0].pipeline.frames(seed, report)
    elif source is not None:
        raise UsageError("give frames or a source, not both")
    else:
        prepared = without_source(prepared)
    session = Session(prepared, seed, keeper)
    run_all(session, islice(iter(frames), n_frames))
    return close(session, report, notes=notes)


def _on_one_source(
    prepared: list[Prepared],
    source: str | None,
    settings: Mapping[str, Any] | None,
    n_frames: int | None,
) -> tuple[list[Prepared], list[str]]:
    """Return the variants on the source given, or on the first's own, and what to say of it."""
    notes: list[str] = []
    given = dict(settings or {})
    if source is None:
        first, notes = first_source(prepared)
        assert first.pipeline.source is not None
        source, own = given_of(first.pipeline.source)
        if n_frames is not None:
            own.pop(COUNT, None)
        given = own | given
    if n_frames is not None and COUNT not in given:
        given |= {COUNT: n_frames} if makes_frames(prepared[0].pipeline, source) else {}
    return on_source(prepared, source, given), notes


def _wanted(variant: str | Path | Pipeline | Wanted, registry: Registry) -> Wanted:
    if isinstance(variant, Wanted):
        return variant
    return parse_wanted(variant, registry) if isinstance(variant, str) else Wanted(variant)


def run_all(session: Session, frames: Iterator[Frame]) -> None:
    """Run all frames through a session, after a few of them to warm it up."""
    for frame in warmed(session, frames):
        session.add(frame)


def warmed(session: Session, frames: Iterator[Frame]) -> Iterator[Frame]:
    """Yield the frames, the session warmed up with the first of them."""
    first = list(islice(frames, WARM_FRAMES))
    session.warm_up(first)
    return chain(first, frames)
