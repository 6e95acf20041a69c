"""What one run of everything came to, kept as columns: a row a frame."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from tactile_graph_tune.choices.comparisons import alternatives
from tactile_graph_tune.table.kinds import Flags, Reals, Truths


@dataclass(frozen=True, eq=False)
class NodeColumn:
    """What a node came to, each of shape (n_frames,).

    Parameters
    ----------
    ok : ndarray of bool
        It had a value.
    failed : ndarray of bool
        It failed, by itself or by what it reads.
    opened : ndarray of bool
        The part of its guard that stays held.
    time_us : ndarray of float64
        Median over the rounds; 0 where it did not run.
    """

    ok: Flags
    failed: Flags
    opened: Flags
    time_us: Reals

    def taken(self, frames: NDArray[np.int64]) -> NodeColumn:
        """Return some frames of it."""
        return NodeColumn(*(c[frames] for c in vars(self).values()))


@dataclass(frozen=True, eq=False)
class FieldColumn:
    """A field's values, shape (n_frames,), NaN where it has none; and the time to read one."""

    values: Reals
    time_us: float


@dataclass(frozen=True, eq=False)
class Table:
    """Everything that is known of every frame.

    Parameters
    ----------
    nodes : mapping of str to NodeColumn
    fields : mapping of str to FieldColumn
        Every number and every yes or no that a guard could read, by ``node.field``.
    losses : mapping of str to ndarray, shape (n_frames,)
        For each node that may answer, the error if it does where it has a value.
    truths : Truths
    scored : ndarray of bool, shape (n_frames,)
        Frames whose truth is known.
    """

    nodes: Mapping[str, NodeColumn]
    fields: Mapping[str, FieldColumn]
    losses: Mapping[str, Reals]
    truths: Truths
    scored: Flags

    @property
    def n(self) -> int:
        """Frames."""
        return len(self.scored)

    def column(self, field: str) -> FieldColumn:
        """Return a field's column; also of recorded fields that other numbers join by ``or``."""
        if field in self.fields:
            return self.fields[field]
        parts = alternatives(field)
        columns = [self.fields[c.field] for c in parts]
        unknown = np.all([np.isnan(c.values) for c in columns], axis=0)
        holds = np.any([p.of(c.values) for p, c in zip(parts, columns, strict=True)], axis=0)
        alike = [c.time_us for name, c in self.fields.items()
                 if [p.field for p in alternatives(name)] == [p.field for p in parts]]  # fmt: skip
        time_us = alike[0] if alike else sum(c.time_us for c in columns)
        return FieldColumn(np.where(unknown, np.nan, holds), time_us)

    def weighed(self, weights: Reals) -> Table:
        """Return the table, its frames counting for so many each, shape (n_frames,)."""
        return replace(self, truths=replace(self.truths, weights=weights))

    def mean(self, values: Reals) -> float:
        """Return the weighed mean of a column."""
        return float(np.average(values, weights=self.truths.weights))

    def taken(self, frames: NDArray[np.int64]) -> Table:
        """Return the table of some frames."""
        return Table(
            {k: c.taken(frames) for k, c in self.nodes.items()},
            {k: replace(c, values=c.values[frames]) for k, c in self.fields.items()},
            {k: v[frames] for k, v in self.losses.items()},
            self.truths.taken(frames),
            self.scored[frames],
        )


def joined(tables: Sequence[Table]) -> Table:
    """Return the table of all frames of several, which have the same columns."""
    first = tables[0]
    return Table(
        {k: _nodes([t.nodes[k] for t in tables]) for k in first.nodes},
        {k: _fields([t.fields[k] for t in tables]) for k in first.fields},
        {k: np.concatenate([t.losses[k] for t in tables]) for k in first.losses},
        Truths(
            np.concatenate([t.truths.full for t in tables]),
            first.truths.price,
            np.concatenate([t.truths.weights for t in tables]),
        ),
        np.concatenate([t.scored for t in tables]),
    )


def _nodes(parts: Sequence[NodeColumn]) -> NodeColumn:
    return NodeColumn(*map(np.concatenate, zip(*(vars(p).values() for p in parts), strict=True)))


def _fields(parts: Sequence[FieldColumn]) -> FieldColumn:
    n_read = [max(1, int((~np.isnan(p.values)).sum())) for p in parts]
    time_us = float(np.average([p.time_us for p in parts], weights=n_read))
    return FieldColumn(np.concatenate([p.values for p in parts]), time_us)
