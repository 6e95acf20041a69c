"""Place boxes in columns from left to right, every wire going rightwards around the boxes.

Columns and order come from `layers`; heights from isotonic regression: each column's boxes come
as near to their neighbours as their order allows.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from statistics import fmean
from typing import NamedTuple

from tactile_graph.draw.layers import (
    SWEEPS,
    Joint,
    Key,
    Links,
    filled_columns,
    layers,
    uncrossed,
)

COLUMN_GAP = 34.0
ROW_GAP = 16.0
WIRE_GAP = 12.0
PORT_GAP = 15.0


class Point(NamedTuple):
    """A place on the drawing, y down."""

    x: float
    y: float


@dataclass(frozen=True)
class Place:
    """Where a box stands: its top left corner and its size."""

    x: float
    y: float
    width: float
    height: float

    @property
    def middle(self) -> float:
        """Height of the box's centre."""
        return self.y + self.height / 2


@dataclass(frozen=True)
class Layout:
    """Places of the boxes, and for each wire the points it goes through.

    By turns a wire bends in the gap between two columns and runs straight through a column; it
    begins with a bend.
    """

    boxes: dict[str, Place]
    routes: tuple[tuple[Point, ...], ...]
    width: float
    height: float


def layout(sizes: Mapping[str, tuple[float, float]], wires: Sequence[Joint]) -> Layout:
    """Return a layout of boxes that depends on nothing but the order they are given in.

    Parameters
    ----------
    sizes : mapping
        Width and height of each box, by name.
    wires : sequence of Joint
        Two boxes may be joined by several wires; there is no cycle.

    Raises
    ------
    networkx.NetworkXUnfeasible
        If the wires form a cycle.
    """
    layer = layers(list(sizes), wires)
    columns, links = filled_columns(sizes, wires, layer)
    columns = uncrossed(columns, links)
    heights = {k: sizes[k][1] if isinstance(k, str) else 0.0 for c in columns for k in c}
    middles = _middles(columns, links, heights)
    lefts, widths = _column_places(sizes, wires, columns, layer)
    boxes: dict[str, Place] = {}
    for name, (width, height) in sizes.items():
        at = layer[name]
        x = lefts[at] + (widths[at] - width) / 2
        boxes[name] = Place(x, middles[name] - height / 2, width, height)
    routes = _routes(boxes, wires, layer, middles, lefts, widths)
    bottom = max([p.y + p.height for p in boxes.values()] + [p.y for r in routes for p in r])
    return Layout(boxes, routes, lefts[-1] + widths[-1], bottom)


def _middles(columns: list[list[Key]], links: Links, heights: dict[Key, float]) -> dict[Key, float]:
    """Return the height of each place's centre; the topmost edge lies at 0."""
    middles: dict[Key, float] = {}
    for column in columns:
        offsets = _offsets(column, heights)
        middles.update({k: o - offsets[-1] / 2 for k, o in zip(column, offsets, strict=True)})
    last = len(columns) - 1
    for sweep in range(SWEEPS + 1):
        order = range(last + 1) if sweep % 2 == 0 else range(last, -1, -1)
        for at in order:
            _settle(columns[at], links, heights, middles, both=sweep > 2)
    _straighten(columns, heights, middles)
    top = min(m - heights[k] / 2 for k, m in middles.items())
    return {k: m - top for k, m in middles.items()}


def _offsets(column: list[Key], heights: dict[Key, float]) -> list[float]:
    """Return how far below the first each place of a column must stand at least."""
    offsets = [0.0]
    for above, below in pairwise(column):
        offsets.append(offsets[-1] + _apart(above, below, heights))
    return offsets


def _apart(above: Key, below: Key, heights: dict[Key, float]) -> float:
    gap = ROW_GAP if isinstance(above, str) and isinstance(below, str) else WIRE_GAP
    return (heights[above] + heights[below]) / 2 + gap


def _straighten(
    columns: list[list[Key]], heights: dict[Key, float], middles: dict[Key, float]
) -> None:
    """Level each long wire over as many columns at a time as there is room for."""
    wires: dict[int, list[tuple[Key | None, Key, Key | None]]] = {}
    for column in columns:
        for above, key, below in zip([None, *column], column, [*column[1:], None], strict=False):
            if isinstance(key, tuple):
                wires.setdefault(key[0], []).append((above, key, below))
    for number in sorted(wires):
        run: list[Key] = []
        low, high = -math.inf, math.inf
        for above, key, below in wires[number]:
            top = -math.inf if above is None else middles[above] + _apart(above, key, heights)
            bottom = math.inf if below is None else middles[below] - _apart(key, below, heights)
            if run and max(low, top) > min(high, bottom):
                _level(run, low, high, middles)
                run, low, high = [], -math.inf, math.inf
            run.append(key)
            low, high = max(low, top), min(high, bottom)
        _level(run, low, high, middles)


def _level(run: list[Key], low: float, high: float, middles: dict[Key, float]) -> None:
    wanted = fmean(middles[key] for key in run)
    middles.update(dict.fromkeys(run, min(max(wanted, low), high)))


def _settle(
    column: list[Key],
    links: Links,
    heights: dict[Key, float],
    middles: dict[Key, float],
    both: bool,
) -> None:
    """Move a column's places to their neighbours' heights, as near as order and room allow."""
    wanted, weights = [], []
    for key in column:
        joined = links.left.get(key, [])
        if both or not joined:
            joined = joined + links.right.get(key, [])
        pulls = [links.pulls[key, j] for j in joined]
        total = sum(pulls)
        wanted.append(
            sum(p * middles[j] for p, j in zip(pulls, joined, strict=True)) / total
            if total
            else middles[key]
        )
        weights.append(total or 1.0)
    offsets = _offsets(column, heights)
    targets = [w - o for w, o in zip(wanted, offsets, strict=True)]
    for key, low, offset in zip(column, _isotonic(targets, weights), offsets, strict=True):
        middles[key] = low + offset


def _isotonic(targets: list[float], weights: list[float]) -> list[float]:
    """Return the nearest non-decreasing sequence in weighted least squares (pool adjacent)."""
    pools: list[tuple[float, float, int]] = []
    for target, weight in zip(targets, weights, strict=True):
        mean, total, count = target, weight, 1
        while pools and pools[-1][0] > mean:
            m, w, n = pools.pop()
            mean = (m * w + mean * total) / (w + total)
            total, count = total + w, count + n
        pools.append((mean, total, count))
    return [mean for mean, _, count in pools for _ in range(count)]


def _column_places(
    sizes: Mapping[str, tuple[float, float]],
    wires: Sequence[Joint],
    columns: list[list[Key]],
    layer: dict[str, int],
) -> tuple[list[float], list[float]]:
    widths = [max([sizes[k][0] for k in c if isinstance(k, str)] + [0.0]) for c in columns]
    gaps = [0.0] + [COLUMN_GAP] * (len(columns) - 1)
    for _, end, room, _ in wires:
        gaps[layer[end]] = max(gaps[layer[end]], COLUMN_GAP + room if room else COLUMN_GAP)
    lefts = [0.0]
    for width, gap in zip(widths, gaps[1:], strict=False):
        lefts.append(lefts[-1] + width + gap)
    return lefts, widths


def _routes(
    boxes: dict[str, Place],
    wires: Sequence[Joint],
    layer: dict[str, int],
    middles: dict[Key, float],
    lefts: list[float],
    widths: list[float],
) -> tuple[tuple[Point, ...], ...]:
    ends = _port_heights(boxes, wires, layer, middles)
    routes = []
    for number, (start, end, _, _) in enumerate(wires):
        a, b = boxes[start], boxes[end]
        points = [Point(a.x + a.width, a.middle)]
        right = Point(lefts[layer[start]] + widths[layer[start]], a.middle)
        points += [right, right] if right.x > points[0].x else []
        for column in range(layer[start] + 1, layer[end]):
            y = middles[number, column]
            points += [Point(lefts[column], y), Point(lefts[column] + widths[column], y)]
        left = Point(lefts[layer[end]], ends[number])
        points += [left] if left.x == b.x else [left, Point(b.x, left.y)]
        routes.append(tuple(points))
    return tuple(routes)


def _port_heights(
    boxes: dict[str, Place],
    wires: Sequence[Joint],
    layer: dict[str, int],
    middles: dict[Key, float],
) -> dict[int, float]:
    """Return where on its box's left side each wire ends: those that come from above, above."""
    arriving: dict[str, list[tuple[float, int]]] = {}
    for number, (start, end, _, _) in enumerate(wires):
        last = layer[end] - 1
        key: Key = start if layer[start] == last else (number, last)
        arriving.setdefault(end, []).append((middles[key], number))
    heights = {}
    for end, items in arriving.items():
        gap = min(PORT_GAP, boxes[end].height / (len(items) + 1))
        for i, (_, number) in enumerate(sorted(items)):
            heights[number] = boxes[end].middle + (i - (len(items) - 1) / 2) * gap
    return heights
