"""What a run must say so that it can be made again, beside the file it writes."""

from __future__ import annotations

import hashlib
import json
import os
import platform
import sys
from collections.abc import Iterator, Mapping, Sequence
from importlib.metadata import version
from pathlib import Path
from typing import Any

from tactile_graph.files import write_whole
from tactile_graph.foreign_text import visible
from tactile_graph.pipeline.graph import Graph
from tactile_graph.pipeline.named_files.named_files import content_of
from tactile_graph.pipeline.plain import plain
from tactile_graph.plugins.names import Plugin
from tactile_graph.plugins.registry import Registry, installed
from tactile_graph.steps.injected import Report


def sidecar(output: str | Path) -> Path:
    """Return the path of the provenance of an output file: ``out.csv.meta.json``."""
    return Path(f"{output}.meta.json")


def provenance(pipeline: Graph, seed: int, report: Report, **more: Any) -> dict[str, Any]:
    """Return how to make a run's output again, as plain data.

    Parameters
    ----------
    pipeline : Graph
        As it ran: resolved, with every setting spelled out.
    seed : int
    report : Report
        Of the source: its counters, troubles and the digests of its files.
    **more
        Whatever else belongs to it (frames, what was asked for).
    """
    used = {p.name: p for p in used_plugins(pipeline, pipeline.registry or installed())}
    source = pipeline.resolved()["source"] or {}
    return {
        **plain(more),
        "seed": seed,
        "source": {
            **source,
            "sha256": dict(report.digests),
            "counts": dict(report.counts),
            "troubles": [{"where": where, "what": what} for where, what in report.troubles],
        },
        "pipeline": pipeline.resolved(),
        "file": {"name": pipeline.file, "sha256": _sha256(pipeline.text)},
        "versions": {
            "tactile-graph": version("tactile-graph"),
            "python": platform.python_version(),
            "numpy": version("numpy"),
            "scipy": version("scipy"),
            "numba": version("numba"),
            "platform": platform.platform(),
        },
        "plugins": {n: {"package": p.package, "version": p.version} for n, p in used.items()},
    }  # fmt: skip


def code_digest(graphs: Sequence[Graph]) -> str:
    """Return a digest of the project's own code, and of that of the packages steps are of."""
    names = {"tactile_graph", *(name for graph in graphs for name in _packages(graph))}
    code = sorted(path for name in names for path in _places(name))
    return digest_of([content_of(path, "*.py") for path in code])


def _places(package: str) -> Iterator[Path]:
    """Yield where a package's code lies; nothing for one that was typed, or lies in an archive."""
    module = sys.modules.get(package)
    file, folders = (getattr(module, name, None) for name in ("__file__", "__path__"))
    if file:
        place = Path(folders[0] if folders else file)
        yield from [place] if place.exists() else []


def _packages(graph: Graph) -> Iterator[str]:
    signatures = [n.signature for n in graph.nodes.values()]
    signatures += [graph.source.signature] if graph.source is not None else []
    for signature in signatures:
        if signature is not None:
            yield getattr(signature.target, "__module__", "").partition(".")[0]
    for node in graph.nodes.values():
        if node.inner is not None:
            yield from _packages(node.inner)


def digest_of(data: Any) -> str:
    """Return a digest of plain data."""
    return _sha256(json.dumps(data, sort_keys=True, default=str))


def _sha256(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()


def used_plugins(pipeline: Graph, registry: Registry) -> Iterator[Plugin]:
    """Yield the plugins that the pipeline, its source and its steps come from."""
    offers = (registry.offer("pipelines", name) for name in registry.names("pipelines"))
    own = os.path.abspath(pipeline.files.place(pipeline.file))
    yield from (o.plugin for o in offers if os.path.abspath(o.target) == own)
    if pipeline.source is not None:
        yield registry.offer("steps", pipeline.source.name).plugin
    for node in pipeline.nodes.values():
        if node.signature is not None:
            yield registry.offer("steps", node.signature.name).plugin
        if node.inner is not None:
            yield from used_plugins(node.inner, registry)


def write_provenance(output: str | Path, data: Mapping[str, Any]) -> None:
    """Write the sidecar of an output file, at once or not at all."""
    write_whole(sidecar(output), visible(json.dumps(data, indent=1, ensure_ascii=False)) + "\n")
