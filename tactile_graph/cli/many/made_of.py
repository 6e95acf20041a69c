"""What a run's output hangs on, by content: a run goes on only where all of it is as it was."""

from __future__ import annotations

from collections.abc import Mapping
from importlib.metadata import version
from typing import Any

from tactile_graph.api.pipeline import Pipeline
from tactile_graph.pipeline.named_files.named_files import (
    content_of,
    is_kept,
    is_there,
    named_by_settings,
    paths_in,
)
from tactile_graph.plugins.registry import installed
from tactile_graph.provenance import code_digest, digest_of, used_plugins

WORDS = {
    "pipeline": "the pipeline or its settings",
    "options": "what is asked of it (--only, --seed, --frames, --format, …)",
    "versions": "a version of the project or of a plugin",
    "code": "the code of the project or of a plugin",
}


def made_of(pipeline: Pipeline, options: Mapping[str, Any]) -> dict[str, str]:
    """Return digests of all that an output hangs on, by what it is.

    Files are taken by their content: those that a setting of the source or of a node names.
    """
    named = {path for path, _ in named_by_settings(pipeline)}
    found = {f"file {path}": content_of(path) for path in sorted(named)}
    registry = pipeline.registry or installed()
    plugins = sorted({(p.name, p.version) for p in used_plugins(pipeline, registry)})
    return {
        "pipeline": digest_of(pipeline.resolved()),
        "options": digest_of(options),
        "versions": digest_of([version("tactile-graph"), version("numpy"), plugins]),
        "code": code_digest([pipeline]),
        **found,
    }


def changed(before: Mapping[str, str], now: Mapping[str, str]) -> str:
    """Return in words what is not as it was; "" if all is."""
    names = [n for n in {**before, **now} if before.get(n) != now.get(n)]
    return ", ".join(WORDS.get(n, n.removeprefix("file ")) for n in names)


def device(pipeline: Pipeline) -> str:
    """Return what the source reads that gives its frames only once; "" if nothing is."""
    named = paths_in(pipeline.source.settings) if pipeline.source is not None else iter(())
    once = (path for path in named if is_there(path) and not is_kept(path))
    return str(next(once, ""))
