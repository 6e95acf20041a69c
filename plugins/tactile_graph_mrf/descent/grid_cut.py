"""`cut_grid`: minimum cuts of small graphs with few edges a node, by pushing and relabelling."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_as_is

LEAST = 1e-9
"""Capacity or excess below which there is none, relative to the largest excess."""


class Graph(NamedTuple):
    """Nodes with few edges each; a cut uses up all but ``near``.

    Parameters
    ----------
    near : ndarray of int64, shape (nodes, degree)
        Each node's neighbours or -1, edge ``q ^ 1`` being edge ``q`` the other way.
    cap : ndarray of float64, shape (nodes, degree)
        What the edges hold.
    excess, sink : ndarray of float64, shape (nodes,)
        What a node gets from the source, and what it can hand to the sink.
    """

    near: NDArray[np.int64]
    cap: NDArray[np.float64]
    excess: NDArray[np.float64]
    sink: NDArray[np.float64]


@compiled_as_is
def heights_to_sink(graph: Graph, least: float, queue: Any, height: Any) -> None:
    """Write each node's distance to the sink along edges that still hold something."""
    near, cap, _, sink = graph
    size, degree = near.shape
    head, tail = 0, 0
    for i in range(size):
        height[i] = size + 1
        if sink[i] > least:
            height[i] = 1
            queue[tail] = i
            tail += 1
    while head < tail:
        i = queue[head]
        head += 1
        for q in range(degree):
            j = near[i, q]
            if j >= 0 and height[j] > size and cap[j, q ^ 1] > least:
                height[j] = height[i] + 1
                queue[tail] = j
                tail += 1


@compiled_as_is
def push_all(graph: Graph, least: float, height: Any, queue: Any, waiting: Any) -> None:
    """Push what nodes have too much towards the sink until none can, or for a while.

    ``queue`` is a ring of nodes; ``waiting`` tells which are in it.
    """
    near, cap, excess, sink = graph
    size, degree = near.shape
    work = 4 * size
    tail = 0
    for i in range(size):
        waiting[i] = excess[i] > least and height[i] <= size
        if waiting[i]:
            queue[tail] = i
            tail += 1
    count, head, tail = tail, 0, tail % size
    while count > 0 and work > 0:
        i = queue[head]
        head = (head + 1) % size
        waiting[i] = False
        count -= 1
        work -= 1
        while excess[i] > least and height[i] <= size:
            flow = min(excess[i], sink[i])
            excess[i] -= flow
            sink[i] -= flow
            lowest = size + 1
            for q in range(degree):
                j = near[i, q]
                if j < 0 or cap[i, q] <= least or excess[i] <= least:
                    continue
                if height[i] == height[j] + 1:
                    flow = min(excess[i], cap[i, q])
                    excess[i] -= flow
                    excess[j] += flow
                    cap[i, q] -= flow
                    cap[j, q ^ 1] += flow
                    if not waiting[j]:
                        waiting[j] = True
                        queue[tail] = j
                        tail = (tail + 1) % size
                        count += 1
                if cap[i, q] > least:
                    lowest = min(lowest, height[j])
            if excess[i] > least:
                height[i] = max(height[i], lowest) + 1


@compiled_as_is
def cut_grid(graph: Graph, goes: Any) -> int:
    """Write which nodes are on the source's side of a minimum cut, as few as can be; count them.

    A. V. Goldberg, R. E. Tarjan 1988, DOI 10.1145/48014.61051.
    """
    near, cap, excess, _ = graph
    size, degree = near.shape
    most = 0.0
    for i in range(size):
        goes[i] = False
        most = max(most, excess[i])
    least = LEAST * most
    if least == 0.0:
        return 0
    height, order = np.empty(size, np.int64), np.empty(size, np.int64)
    queue, waiting = np.empty(size, np.int64), np.empty(size, np.bool_)
    pending = True
    while pending:
        heights_to_sink(graph, least, order, height)
        push_all(graph, least, height, queue, waiting)
        pending = False
        for i in range(size):
            pending = pending or (excess[i] > least and height[i] <= size)
    found = 0
    for i in range(size):
        if excess[i] > least:
            goes[i] = True
            order[found] = i
            found += 1
    head = 0
    while head < found:
        i = order[head]
        head += 1
        for q in range(degree):
            j = near[i, q]
            if j >= 0 and not goes[j] and cap[i, q] > least:
                goes[j] = True
                order[found] = j
                found += 1
    return found
