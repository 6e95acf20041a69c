"""Which column of a drawing each box stands in, and in which order, with few wires crossing.

Layers by longest path, dummy places where a wire passes a column, barycentre sweeps against
crossings (Sugiyama, Tagawa and Toda 1981, 10.1109/TSMC.1981.4308636).
"""

from __future__ import annotations

from bisect import bisect_right, insort
from collections.abc import Iterable, Sequence
from itertools import pairwise
from statistics import fmean
from typing import NamedTuple

import networkx as nx

SWEEPS = 12

Key = str | tuple[int, int]
"""A box by its name, or the place (wire, column) where a wire passes a column."""


class Joint(NamedTuple):
    """A wire to lay: its ends, room for a label before its end, how much it wants to be level."""

    start: str
    end: str
    room: float = 0.0
    pull: float = 1.0


def layers(names: list[str], wires: Sequence[Joint]) -> dict[str, int]:
    """Return each box's column: one right of the rightmost box it reads."""
    graph: nx.DiGraph[str] = nx.DiGraph()
    graph.add_nodes_from(names)
    graph.add_edges_from((w.start, w.end) for w in wires)
    layer = {n: i for i, group in enumerate(nx.topological_generations(graph)) for n in group}
    for name in reversed(names[1:]):
        if graph.in_degree(name) == 0 and graph.out_degree(name) > 0:
            # What reads nothing stands beside what reads it, not at the far left.
            layer[name] = min(layer[n] for n in graph.successors(name)) - 1
    return layer


class Links:
    """Which places of the columns beside a place it is joined to."""

    def __init__(self) -> None:
        self.left: dict[Key, list[Key]] = {}
        self.right: dict[Key, list[Key]] = {}
        self.pulls: dict[tuple[Key, Key], float] = {}

    def join(self, a: Key, b: Key, pull: float) -> None:
        """Join a place to one in the column right of it."""
        self.right.setdefault(a, []).append(b)
        self.left.setdefault(b, []).append(a)
        # Long wires pull most, so that they run straight.
        pull *= (1.0, 3.0, 9.0)[isinstance(a, tuple) + isinstance(b, tuple)]
        self.pulls[a, b] = self.pulls[b, a] = max(pull, self.pulls.get((a, b), 0.0))


def filled_columns(
    names: Iterable[str], wires: Sequence[Joint], layer: dict[str, int]
) -> tuple[list[list[Key]], Links]:
    """Return the boxes and passing wires of each column, and what is joined to what."""
    columns: list[list[Key]] = [[] for _ in range(max(layer.values()) + 1)]
    for name in names:
        columns[layer[name]].append(name)
    links = Links()
    for number, (start, end, _, pull) in enumerate(wires):
        before: Key = start
        for column in range(layer[start] + 1, layer[end]):
            columns[column].append((number, column))
            links.join(before, (number, column), pull)
            before = (number, column)
        links.join(before, end, pull)
    return columns, links


def uncrossed(columns: list[list[Key]], links: Links) -> list[list[Key]]:
    """Return the columns in the order with the fewest crossings of all the sweeps."""
    best, fewest = columns, _crossings(columns, links)
    order = [list(c) for c in columns]
    for sweep in range(SWEEPS):
        if fewest == 0:
            break
        if sweep % 2 == 0:
            for before, column in pairwise(order):
                _sort(column, before, links.left)
        else:
            for before, column in zip(order[:0:-1], order[-2::-1], strict=True):
                _sort(column, before, links.right)
        crossings = _crossings(order, links)
        if crossings < fewest:
            best, fewest = [list(c) for c in order], crossings
    return best


def _sort(column: list[Key], before: list[Key], joined: dict[Key, list[Key]]) -> None:
    rank = {key: float(i) for i, key in enumerate(before)}
    own = {key: float(i) for i, key in enumerate(column)}
    column.sort(key=lambda k: fmean([rank[j] for j in joined[k]]) if k in joined else own[k])


def _crossings(columns: list[list[Key]], links: Links) -> int:
    total = 0
    for column, after in pairwise(columns):
        rank = {key: i for i, key in enumerate(after)}
        seen: list[int] = []
        for key in column:
            ends = sorted(rank[j] for j in links.right.get(key, []))
            total += sum(len(seen) - bisect_right(seen, e) for e in ends)
            for e in ends:
                insort(seen, e)
    return total
