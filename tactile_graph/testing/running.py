"""Run a step or a pipeline as a test wants it: checked, watched, and with errors raised."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tactile_graph.errors import PluginError, UsageError
from tactile_graph.plugins.registry import Registry

if TYPE_CHECKING:
    from tactile_graph.api.result import Result


def run_step(
    step: str | Callable[..., Any],
    *inputs: Any,
    settings: Mapping[str, Any] | None = None,
    registry: Registry | None = None,
) -> Any:
    """Return what a step gives for inputs, as it comes out of a pipeline: read-only.

    Parameters
    ----------
    step : str or callable
        Its name, or the function or class itself.
    *inputs : object
        By the order of its ports; a bare array becomes an image of pitch 1 cm and quantity ``raw``.
    settings : mapping, optional
        As under ``with`` in a pipeline; checked as there.
    registry : Registry, optional
        The installed plugins if not given.

    Raises
    ------
    UsageError
        If a setting is not allowed.
    PluginError
        If the step writes into its inputs, or gives something else than it promises.
    """
    from tactile_graph.engine.calls.watched import watched
    from tactile_graph.engine.operations.freeze import freeze
    from tactile_graph.testing.subject import subject_of
    from tactile_graph.wires import Image

    subject = subject_of(step, settings or {}, registry)
    if isinstance(subject, str):
        raise UsageError(subject)
    given = [Image(np.array(i)) if isinstance(i, np.ndarray) else i for i in inputs]
    names = [p.name for p in subject.signature.ports]
    call = watched(subject.call(), f"step {subject.signature.name!r}")
    ports = dict(zip(names, given, strict=False))
    value = freeze(call(**ports))
    wrong = subject.misfit(ports, value)
    if wrong:
        raise PluginError(f"step {subject.signature.name!r} {wrong}")
    return value


def run_pipeline(
    pipeline: str | Path,
    *frames: Any,
    settings: Mapping[str, Any] | None = None,
    registry: Registry | None = None,
    seed: int = 0,
) -> list[Result]:
    """Return the results of frames, in order; a failed node is an error of the test.

    Parameters
    ----------
    pipeline : str or Path
        Its text (anything with a line break or a brace), name or file.
    *frames : Frame or ndarray
        Those of the pipeline's own source if none is given.
    settings : mapping, optional
        ``{"node.setting": value}``.
    registry : Registry, optional
        The installed plugins if not given.
    seed : int

    Raises
    ------
    PluginError
        If a step writes into its inputs, or gives something else than it promises.
    Exception
        Whatever a node failed with.
    """
    from tactile_graph.api.pipeline import load, loads

    text = str(pipeline)
    is_text = "\n" in text or "{" in text
    made = loads(text, registry=registry) if is_text else load(pipeline, registry)
    if settings:
        made = made.with_settings(settings)
    runner = made.runner(seed=seed, verify=True)
    results = []
    for result in made.results(frames or made.frames(seed), runner):
        for failed in result.failures:
            raise failed.error
        results.append(result)
    return results
