"""The least that any choice could reach: an oracle that knows every rung's error beforehand."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from tactile_graph import Pipeline
from tactile_graph.inspect import FRAME, NodeKind
from tactile_graph_tune.table.columns import Reals, Table

N_PRICES = 60


class Options(NamedTuple):
    """What a frame may be answered by: nothing, or any one rung; shape (n_options, n_frames)."""

    time_us: Reals
    loss: Reals


def options_of(pipeline: Pipeline, table: Table, leaves: Mapping[str, str]) -> Options:
    """Return the options of each frame.

    Parameters
    ----------
    pipeline : Pipeline
        Without guards.
    table : Table
    leaves : mapping of str to str
        What may answer -> its node.

    Notes
    -----
    An option takes what it reads and nothing else: whoever knows the errors needs no field of any
    other node.
    """
    times, losses = [np.zeros(table.n)], [table.none]
    for leaf, node in leaves.items():
        column = table.nodes[node]
        spent = sum((table.nodes[n].time_us for n in _behind(pipeline, node)), np.zeros(table.n))
        times.append(np.where(column.ok, spent, 0.0))
        losses.append(np.where(column.ok, table.losses[leaf], table.none))
    return Options(np.stack(times), np.stack(losses))


def _behind(pipeline: Pipeline, name: str) -> set[str]:
    """Return a node and all that its ports read, guards that stay left aside."""
    found: set[str] = set()
    waiting = [name]
    while waiting:
        node = pipeline.nodes[waiting.pop()]
        found.add(node.name)
        refs = [r for b in node.inputs for r in b.refs]
        refs += node.choices if node.kind is not NodeKind.FIRST_OF else node.choices[:1]
        waiting += [r.node for r in refs if r.node != FRAME and r.node not in found]
    return found


class Bound(NamedTuple):
    """The oracle's mean time and mean error, from the cheapest to the best."""

    time_us: Reals
    loss: Reals

    def time_at(self, loss: float) -> float:
        """Return the least mean time at a mean error; NaN where even the oracle errs more."""
        fine = self.loss <= loss
        if not fine.any():
            return float("nan")
        k = int(np.argmax(fine))  # times rise, errors fall
        if k == 0:
            return float(self.time_us[0])
        (a, b), (x, y) = self.loss[k - 1 : k + 1], self.time_us[k - 1 : k + 1]
        return float(y if a == b else x + (y - x) * (a - loss) / (a - b))


def bound_of(options: Options) -> Bound:
    """Return the least mean time for each mean error.

    Notes
    -----
    For each price of error every frame takes its own best option; the points between two prices
    are mixtures of both. No choice of guards, which sees fields only, can lie below this line.
    """
    times, losses = options
    spread_us = float(times.max()) or 1.0
    spread = float(losses.max()) or 1.0
    prices = [0.0, *np.geomspace(1e-4, 1e6, N_PRICES) * spread_us / spread]
    points = []
    every = np.arange(times.shape[1])
    for price in prices:
        k = (times + price * losses + 1e-12 * losses).argmin(axis=0)
        points.append((float(times[k, every].mean()), float(losses[k, every].mean())))
    points = sorted(set(points))
    return Bound(np.array([p[0] for p in points]), np.array([p[1] for p in points]))
