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
from tactile_graph.plugin_code import digests_of
from tactile_graph.plugins.names import OWN, Plugin
from tactile_graph.plugins.registry import Registry, installed
from tactile_graph.steps.injected import Report
from tactile_graph.steps.signature import Signature


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
    """Return a digest of the project's own code, and of all that the plugins of steps installed."""
    own, others = {"tactile_graph"}, dict[str, set[str]]()
    for graph in graphs:
        registry = graph.registry or installed()
        for signature in _signatures(graph):
            module = getattr(signature.target, "__module__", None) or ""
            package = registry.offer("steps", signature.name, graph.file).plugin.package
            if package == OWN:
                own.add(module.partition(".")[0])
            else:
                others.setdefault(package, set()).add(module)
    folders = (Path(file).parent for name in sorted(own) if (file := _file(name)))
    return digest_of([
        [content_of(folder, "*.py") for folder in folders],
        [digests_of(package, modules) for package, modules in sorted(others.items())],
    ])  # fmt: skip


def _file(package: str) -> str | None:
    """Return the first file of a package of the project's own; None where it is an archive's."""
    file = getattr(sys.modules.get(package), "__file__", None)
    return file if file and Path(file).exists() else None


def _signatures(graph: Graph) -> Iterator[Signature]:
    found = [n.signature for n in graph.nodes.values()]
    found += [graph.source.signature] if graph.source is not None else []
    yield from (signature for signature in found if signature is not None)
    for node in graph.nodes.values():
        if node.inner is not None:
            yield from _signatures(node.inner)


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
