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
from tactile_graph.files import sha256_of
from tactile_graph.pipeline.graph import Graph
from tactile_graph.plugins.registry import installed
from tactile_graph.provenance import used_plugins

JOURNALS = "*.journal"
"""Of a folder that vouches for itself: they hold the checksums of all else that is in it."""
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
    found = {f"file {path}": _content(path) for path in sorted(set(_files(pipeline)))}
    registry = pipeline.registry or installed()
    plugins = sorted({(p.name, p.version) for p in used_plugins(pipeline, registry)})
    return {
        "pipeline": _digest(pipeline.resolved()),
        "options": _digest(options),
        "versions": _digest([version("tactile-graph"), version("numpy"), plugins]),
        "code": _digest([_content(p, "*.py") for p in _code(pipeline)]),
        **found,
    }


def changed(before: Mapping[str, str], now: Mapping[str, str]) -> str:
    """Return in words what is not as it was; "" if all is."""
    names = [n for n in {**before, **now} if before.get(n) != now.get(n)]
    return ", ".join(WORDS.get(n, n.removeprefix("file ")) for n in names)


def device(pipeline: Pipeline) -> str:
    """Return what the source reads that gives its frames only once; "" if nothing is."""
    values = _values(pipeline.source.settings) if pipeline.source is not None else iter(())
    once = (v for v in values if _there(v) and not (v.is_file() or v.is_dir()))
    return str(next(once, ""))


def _files(graph: Graph) -> Iterator[Path]:
    """Yield the files and folders that settings name."""
    settings = [node.settings for node in graph.nodes.values()]
    settings += [graph.source.settings] if graph.source is not None else []
    for path in (p for s in settings for p in _values(s)):
        if _there(path) and (path.is_file() or path.is_dir()):
            yield path
    for node in graph.nodes.values():
        if node.inner is not None:
            yield from _files(node.inner)


def _values(settings: Any) -> Iterator[Path]:
    if isinstance(settings, Mapping):
        settings = list(settings.values())
    if isinstance(settings, list | tuple):
        for value in settings:
            yield from _values(value)
    elif isinstance(settings, str | Path) and str(settings).strip():
        yield Path(settings)


def _there(path: Path) -> bool:
    try:
        return path.exists()
    except (OSError, ValueError):  # a text that no file can be called
        return False


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


def _content(path: Path, which: str = "*") -> str:
    files = [path]
    if path.is_dir():
        files = sorted(path.glob(JOURNALS)) or sorted(p for p in path.rglob(which) if p.is_file())
    whole = hashlib.sha256()
    for file in files:
        of_file = bytes.fromhex(sha256_of(file))
        whole.update(f"{file.relative_to(path)}\n".encode() + of_file)
    return whole.hexdigest()


def _digest(data: Any) -> str:
    text = json.dumps(data, sort_keys=True, default=str)
    return hashlib.sha256(text.encode()).hexdigest()
