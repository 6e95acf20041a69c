"""Schedules of a table's choices: those that know nothing of time, and the best that knows all."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from deadline_parts.table import Array, Table

GRID_NS = 5_000
MOST_WAITING = 64
SHED = -1

Choices = NDArray[np.intp]


class Came(NamedTuple):
    """What a schedule came to: the choice of each frame (-1 where it was shed), and its latency."""

    choices: Choices
    latency_ns: Array


def fixed(table: Table, choice: int, period_ns: int) -> Came:
    """Return what one choice for all frames comes to, the oldest shed where 64 wait."""
    n = len(table.frames)
    choices, latency = np.full(n, SHED), np.full(n, np.inf)
    now = i = 0
    while i < n:
        now = max(now, i * period_ns)
        i = max(i, min(now // period_ns, n - 1) - MOST_WAITING + 1)
        now += int(table.took_ns[choice, i])
        choices[i], latency[i] = choice, now - i * period_ns
        i += 1
    return Came(choices, latency)


def best_schedule(table: Table, values: Array, period_ns: int, deadline_ns: int) -> Came:
    """Return the schedule of least sum of values that has every frame on time that can be.

    It knows beforehand how long every choice will take on every frame. Where none can be on time,
    as in a stall of the machine, the quickest is taken. Backlogs are rounded up to
    5 us, so that what it finds can be kept.

    Parameters
    ----------
    table : Table
    values : ndarray, shape (choices, frames)
        What it is charged for each choice.
    period_ns, deadline_ns : int
    """
    n_choices, n = table.took_ns.shape
    backlog = np.arange(deadline_ns // GRID_NS + 1) * GRID_NS
    cost = np.where(backlog == 0, 0.0, np.inf)
    came = np.zeros((n, len(backlog)), np.int32)
    for i in range(n):
        after = np.full(len(backlog), np.inf)
        for k in range(n_choices):
            end = backlog + table.took_ns[k, i]
            at = np.ceil(np.maximum(0, end - period_ns) / GRID_NS).astype(int)
            sources = np.flatnonzero((end <= deadline_ns) & (at < len(cost)) & np.isfinite(cost))
            charged = cost[sources] + values[k, i]
            order = np.argsort(-charged, kind="stable")  # of several to one place the least is last
            sources, charged = sources[order], charged[order]
            better = charged < after[at[sources]]
            after[at[sources[better]]] = charged[better]
            came[i, at[sources[better]]] = sources[better] * n_choices + k
        if not np.isfinite(after).any():
            source, k = int(cost.argmin()), int(table.took_ns[:, i].argmin())
            after[-1], came[i, -1] = cost[source] + values[k, i], source * n_choices + k
        cost = after
    return _traced(table, came, int(cost.argmin()), period_ns)


def _traced(table: Table, came: NDArray[np.int32], place: int, period_ns: int) -> Came:
    n_choices, n = table.took_ns.shape
    choices = np.zeros(n, np.intp)
    for i in range(n - 1, -1, -1):
        place, choices[i] = divmod(int(came[i, place]), n_choices)
    return Came(choices, latencies(table, choices, period_ns))


def latencies(table: Table, choices: Choices, period_ns: int) -> Array:
    """Return each frame's time from arrival to answer, in order, shape (frames,)."""
    now, found = 0.0, []
    for i, choice in enumerate(choices):
        now = max(now, i * period_ns) + table.took_ns[choice, i]
        found.append(now - i * period_ns)
    return np.array(found)
