"""Any source step as command lines name it: its settings checked, its frames."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from tactile_graph.cli.arguments import COUNT, source_settings_of, takes_count
from tactile_graph.engine.calls.sources import open_source
from tactile_graph.errors import Mark, UsageError
from tactile_graph.pipeline.graph import Source
from tactile_graph.plugins.registry import installed
from tactile_graph.steps.injected import Report
from tactile_graph.steps.settings import validate_settings
from tactile_graph.steps.signature import Kind
from tactile_graph.wires.frame import Frame


def frames_of_source(
    step: str, settings: Mapping[str, Any], report: Report, seed: int = 0
) -> Iterator[Frame]:
    """Return the frames of a source step of any plugin.

    Raises
    ------
    UsageError
        If there is no such step, it is no source, or a setting is wrong.
    """
    signature = installed().step(step)
    if signature.kind is not Kind.SOURCE:
        raise UsageError(f"--source {step}: this step is no source: it yields no frames")
    source = Source(signature, _checked(step, settings), Mark("<command line>", 1, 1))
    return open_source(source, seed, report)


def as_many(step: str, settings: Mapping[str, Any], n_frames: int | None) -> dict[str, Any]:
    """Return settings by which a source that makes its frames makes so many, unless they say."""
    if n_frames is None or not takes_count(step):
        return dict(settings)
    return {COUNT: n_frames, **settings}


def reader_settings(texts: Sequence[str]) -> dict[str, Any]:
    """Return the settings of ``recording`` that texts give, checked; raises UsageError."""
    given = source_settings_of("recording", texts)
    checked = _checked("recording", {"path": "recording", **given})
    return {k: v for k, v in checked.items() if k in given}


def _checked(step: str, given: Mapping[str, Any]) -> dict[str, Any]:
    values, troubles = validate_settings(installed().step(step), dict(given))
    lines = [f"source {step}, {'.'.join(map(str, p)) + ': ' if p else ''}{m}" for p, m in troubles]
    if lines:
        raise UsageError("\n".join(lines))
    return values
