"""What a run's output hangs on, by content: a run goes on only where all of it is as it was."""

from __future__ import annotations

import hashlib
import json
import sys
from collections.abc import Iterator, Mapping
from importlib.metadata import version
from pathlib import Path
from typing import Any

from tactile_graph.api.pipeline import Pipeline
from tactile_graph.pipeline.graph import Graph
from tactile_graph.pipeline.named_files.named_files import (
    content_of,
    is_kept,
    is_there,
    named_by_settings,
    paths_in,
)
from tactile_graph.plugins.registry import installed
from tactile_graph.provenance import used_plugins

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
        "pipeline": _digest(pipeline.resolved()),
        "options": _digest(options),
        "versions": _digest([version("tactile-graph"), version("numpy"), plugins]),
        "code": _digest([content_of(p, "*.py") for p in _code(pipeline)]),
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


def _code(graph: Graph) -> list[Path]:
    """Return where the project's own code lies, and that of the packages that steps are of."""
    names = {"tactile_graph", *_packages(graph)}
    places = ((getattr(m, "__path__", None), m.__file__) for m in map(sys.modules.get, names) if m)
    return sorted(Path(folders[0] if folders else file) for folders, file in places if file)


def _packages(graph: Graph) -> Iterator[str]:
    signatures = [n.signature for n in graph.nodes.values()]
    signatures += [graph.source.signature] if graph.source is not None else []
    for signature in signatures:
        if signature is not None:
            yield getattr(signature.target, "__module__", "").partition(".")[0]
    for node in graph.nodes.values():
        if node.inner is not None:
            yield from _packages(node.inner)


def _digest(data: Any) -> str:
    text = json.dumps(data, sort_keys=True, default=str)
    return hashlib.sha256(text.encode()).hexdigest()
