"""The files that a pipeline's source names: pads, scenes, presets and recordings, opened."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from tactile_graph.cli.file_kinds import file_kind
from tactile_graph.engine.calls.sources import open_source
from tactile_graph.errors import PipelineError, Problem, TactileGraphError
from tactile_graph.pipeline.graph import Source
from tactile_graph.plugins.registry import Registry
from tactile_graph.steps.injected import Report


def problems_of_source(found: Registry, source: Source) -> list[Problem]:
    """Return what is wrong with the files that a source's settings name.

    A setting that is called as a kind of file is (``pad``, ``scene``, ``preset``) names one; of
    steps that read recordings the one that takes the path does. Of a recording the first frame is
    read. Where each of them is right, the source's own ``check`` tells whether they go together.
    """
    problems = problems_of_records(found, source) or problems_together(source)
    if found.has("readers", source.name):
        setting = str(found.offer("readers", source.name).target)
        for path in _listed(source.settings.get(setting)):
            settings = {**source.settings, setting: path}
            problems += _of_recording(replace(source, settings=settings), setting)
    return problems


def problems_of_records(found: Registry, source: Source) -> list[Problem]:
    """Return what is wrong with the files that a source's settings name, but for recordings."""
    problems: list[Problem] = []
    for name, value in source.settings.items():
        if isinstance(value, str) and found.has("file_kinds", name):
            problems += _of_record(found, source, name, value)
    return problems


def problems_together(source: Source) -> list[Problem]:
    """Return what is wrong with a source's settings together, as its attribute ``check`` tells.

    That is a function which takes the settings as the source does, and raises what is wrong.
    """
    check = getattr(source.signature.target, "check", None)
    if check is None:
        return []
    try:
        check(**source.signature.arguments(source.settings))
    except TactileGraphError as error:
        return [Problem(source.mark, f"source: {error}")]
    return []


def _of_record(found: Registry, source: Source, name: str, value: str) -> Iterator[Problem]:
    try:
        file_kind(found, name).read(value)
    except PipelineError as error:
        for problem in error.problems:
            mark = problem.mark or source.mark
            told = problem.message if problem.mark else f"source, {name}: {problem.message}"
            yield Problem(mark, told, problem.snippet)
    except TactileGraphError as error:
        yield Problem(source.mark, f"source, {name}: {error}")


def _of_recording(source: Source, setting: str) -> Iterator[Problem]:
    frames = open_source(source, 0, Report())
    try:
        if next(frames, None) is None:
            path = source.settings[setting]
            yield Problem(source.mark, f"source, {setting}: {path} holds no frame")
    except (TactileGraphError, OSError) as error:
        yield Problem(source.mark, f"source, {setting}: {error}")


def _listed(value: Any) -> list[Any]:
    return value if isinstance(value, list) else [] if value is None else [value]
