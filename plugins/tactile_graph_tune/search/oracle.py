"""The least that any choice could reach: an oracle that knows every rung's error beforehand."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from scipy import sparse
from scipy.optimize import linprog

from tactile_graph import Pipeline
from tactile_graph.inspect import FRAME, NodeKind
from tactile_graph_tune.table.columns import Table
from tactile_graph_tune.table.kinds import SLACK, Reals, Truths


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
    times, losses = [np.zeros(table.n)], [table.truths.none]
    for leaf, node in leaves.items():
        column = table.nodes[node]
        spent = sum((table.nodes[n].time_us for n in _behind(pipeline, node)), np.zeros(table.n))
        times.append(np.where(column.ok, spent, 0.0))
        losses.append(np.where(column.ok, table.losses[leaf], table.truths.none))
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


class Bound:
    """The oracle's least mean time for a mean error and a share of missed frames.

    Parameters
    ----------
    options : Options
    truths : Truths

    Notes
    -----
    Mixtures of options frame by frame, as a linear programme: no choice of guards, which sees
    fields only, can lie below its least time. Nothing is answered where nothing lies: that costs
    neither time nor a false answer.
    """

    def __init__(self, options: Options, truths: Truths) -> None:
        full, weights = truths.full, truths.weights[truths.full]
        times, losses = options.time_us[:, full], options.loss[:, full]
        missed = losses >= truths.price
        self._n, n_options = int(full.sum()), len(times)
        each = weights / weights.sum() if self._n else weights
        self._share = float(weights.sum() / truths.weights.sum())
        self._time_us = (each * times).ravel()
        self._limited: Reals = np.stack([(each * losses).ravel(), (each * missed).ravel()])
        # Of each frame's options, side by side in the columns, the shares sum to 1. (SciPy's types
        # know nothing of sparse constraints, which linprog takes.)
        self._shares: Any = sparse.hstack([sparse.identity(self._n, format="csr")] * n_options)
        self.least_error = float(losses.min(axis=0) @ each) if self._n else 0.0

    def time_at(self, error: float, missed: float) -> float:
        """Return the least mean time within both; NaN where even the oracle errs or misses more."""
        if not self._n:
            return 0.0
        found = linprog(
            self._time_us, self._limited, np.array([error, missed]) + SLACK,
            self._shares, np.ones(self._n),
        )  # fmt: skip
        if found.fun is None:
            return float("nan")
        return self._share * float(found.fun)
