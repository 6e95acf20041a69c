"""What a node hangs on beside its key: the code of steps, and what stands in files they name."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any
from weakref import WeakKeyDictionary

from tactile_graph.pipeline.graph import Graph, Node
from tactile_graph.pipeline.named_files.named_files import content_of, is_kept, paths_in
from tactile_graph.pipeline.wiring import Ref

MadeOf = dict[str, tuple[Any, list[str]]]
"""By the key of a node and of each that it reads: its step, and digests of the step's files."""
_known: WeakKeyDictionary[Graph, dict[str, MadeOf]] = WeakKeyDictionary()


def made_of(graph: Graph) -> dict[str, MadeOf]:
    """Return what each node that keeps something is made of, as it is when first asked.

    A pipeline is what it was loaded as: files that change later make another of it when it is
    loaded again.

    Parameters
    ----------
    graph : Graph

    Returns
    -------
    dict
        By name; equal for nodes of equal key where code and files are as they were.
    """
    found = _known.get(graph)
    if found is None:
        keeping = [node.name for node in graph.nodes.values() if node.keeps]
        found = _known[graph] = {name: _made_of(graph, name) for name in keeping}
    return found


def _made_of(graph: Graph, name: str) -> MadeOf:
    nodes = _with_inner(graph, graph.needed([Ref(name)]))
    return {n.key: (n.signature.target, _contents(n)) for n in nodes if n.signature is not None}


def _with_inner(graph: Graph, names: Iterable[str]) -> Iterator[Node]:
    for name in names:
        node = graph.nodes[name]
        yield node
        if node.inner is not None:
            yield from _with_inner(node.inner, node.inner.nodes)


def _contents(node: Node) -> list[str]:
    """Return digests of the files that a node's settings name, but for those that it writes."""
    named = [] if node.is_sink else paths_in(node.settings)
    # A folder of a bare name may have nothing to do with a text such as "raw".
    return [_content(p) for p in named if is_kept(p) and (p.suffix or p.is_file())]


def _content(path: Path) -> str:
    try:
        return content_of(path)
    except OSError:  # the step that reads it says so
        return ""
