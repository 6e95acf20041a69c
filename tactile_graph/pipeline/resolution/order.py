"""The order in which the nodes of a file can be resolved, and the cycles that forbid one."""

from __future__ import annotations

import heapq
from collections.abc import Iterator, Mapping
from graphlib import CycleError, TopologicalSorter

from tactile_graph.pipeline.conditions.conditions import names_in
from tactile_graph.pipeline.declaration import Declaration, NodeDeclaration


def resolvable_order(declaration: Declaration) -> tuple[list[str], list[list[str]]]:
    """Return the nodes, each after those it reads, and every cycle found on the way.

    A cycle is reported and cut, so that its nodes are still checked in all else.
    """
    graph = {n: sorted(_reads(node, declaration)) for n, node in declaration.nodes.items()}
    cycles: list[list[str]] = []
    while True:
        try:
            return _in_file_order(graph), cycles
        except CycleError as error:
            loop: list[str] = list(reversed(error.args[1]))
            cycles.append(loop)
            for name in set(loop):
                graph[name] = [r for r in graph[name] if r not in loop]


def _reads(node: NodeDeclaration, declaration: Declaration) -> set[str]:
    """Return the nodes that a node reads, its condition included."""
    names = {text.partition(".")[0] for text in _wired(node)}
    if node.when:
        names |= _names_in(node.when, declaration.conditions)
    return names & declaration.nodes.keys()


def _wired(node: NodeDeclaration) -> Iterator[str]:
    yield from node.first_of or []
    values = node.inputs.values() if isinstance(node.inputs, dict) else [node.inputs]
    for value in values:
        yield from value if isinstance(value, list) else [value] if value else []


def _names_in(text: str, conditions: Mapping[str, str]) -> set[str]:
    """Return the names a condition reads, through named conditions too."""
    found = set[str]()
    waiting = [text]
    while waiting:
        names = names_in(waiting.pop()) - found
        found |= names
        waiting += [conditions.get(n, "") for n in sorted(names)]
    return found


def _in_file_order(graph: Mapping[str, list[str]]) -> list[str]:
    """Return the nodes, each after those it reads, otherwise in the order of the file.

    Raises
    ------
    CycleError
        If the nodes read each other in a circle.
    """
    place = {name: i for i, name in enumerate(graph)}
    sorter = TopologicalSorter(graph)
    sorter.prepare()
    ready: list[int] = []
    order: list[str] = []
    names = list(graph)
    while sorter.is_active():
        for name in sorter.get_ready():
            heapq.heappush(ready, place[name])
        name = names[heapq.heappop(ready)]
        order.append(name)
        sorter.done(name)
    return order
