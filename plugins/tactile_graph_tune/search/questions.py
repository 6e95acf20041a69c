"""Every comparison that might be asked at a place: all fields known before it, at many levels."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from tactile_graph import Pipeline
from tactile_graph_tune.choices.comparisons import (
    HOLDS,
    HOLDS_NOT,
    Comparison,
    alternatives,
    node_of,
)
from tactile_graph_tune.choices.declared import Declared, Place
from tactile_graph_tune.search.cascade import Asked
from tactile_graph_tune.table.columns import Table
from tactile_graph_tune.table.fields import is_flag
from tactile_graph_tune.table.kinds import Reals

SHARES = (0.01, 0.03, 0.06, *np.linspace(0.1, 0.9, 13), 0.94, 0.97, 0.99)
"""Shares of the frames on either side of the levels that are tried first."""
FINER = 60
"""Levels of a field that is already asked."""


class Batch(NamedTuple):
    """Comparisons of one field, side by side."""

    comparisons: tuple[Comparison, ...]
    asked: Asked


def fields_by_place(
    declared: Declared, pipeline: Pipeline, table: Table, only: Sequence[str] = ()
) -> dict[str, list[str]]:
    """Return for each place the fields that may be asked there.

    Parameters
    ----------
    declared : Declared
    pipeline : Pipeline
        Without the guards to be chosen.
    table : Table
    only : sequence of str
        The fields to be asked at all; all where empty.

    Notes
    -----
    A field must belong to a node that stands before every node of the place, so that no guard can
    ever wait for itself; of fields that say the same of every frame one is taken.
    """
    before = {name: k for k, name in enumerate(pipeline.nodes)}
    usable = [f for f in table.fields if not only or f in only]
    found = {}
    for place in declared.places.values():
        first = min(before[n] for n in place.nodes)
        names = [f for f in usable if before[node_of(f)] < first]
        names += [c.field for c in place.given if c.field not in names and c.field in table.fields]
        found[place.name] = _distinct(names, place, table)
    return found


def _distinct(names: Sequence[str], place: Place, table: Table) -> list[str]:
    kept: dict[bytes, str] = {}
    own = [c.field for c in place.given]
    for name in [*own, *names]:
        if name not in table.fields:
            continue
        values = table.fields[name].values
        known = values[~np.isnan(values)]
        if known.size and (known.min() < known.max() or name in own):
            kept.setdefault(values.tobytes(), name)
    return list(dict.fromkeys(kept.values()))


class Questions:
    """Makes batches of comparisons, each once.

    Parameters
    ----------
    pipeline : Pipeline
    table : Table
        Of the frames that are chosen by.
    fields : mapping
        For each place the fields that may be asked there.
    """

    def __init__(
        self, pipeline: Pipeline, table: Table, fields: Mapping[str, Sequence[str]]
    ) -> None:
        self._pipeline, self._table, self.fields = pipeline, table, fields
        self._made: dict[tuple[str, bool], Batch | None] = {}

    def batch(self, field: str, finer: bool = False) -> Batch | None:
        """Return the comparisons of a field; None where no frame knows it."""
        key = (field, finer)
        if key not in self._made:
            self._made[key] = self._batch(field, finer)
        return self._made[key]

    def _batch(self, field: str, finer: bool) -> Batch | None:
        column = self._table.fields[field]
        known = column.values[~np.isnan(column.values)]
        if not known.size:
            return None
        joined = bool(alternatives(field))
        if joined or is_flag(self._pipeline.type_of(self._pipeline.ref(field))):
            made = tuple(Comparison(field, sign, 0.0) for sign in (HOLDS, HOLDS_NOT))
        else:
            levels = levels_between(known, FINER if finer else 0)
            made = tuple(Comparison(field, sign, x) for sign in ("<", ">") for x in levels)
        if not made:
            return None
        holds = np.stack([c.of(column.values) for c in made])
        return Batch(made, Asked(field, made[0].node, holds, column.time_us))


def levels_between(known: Reals, n_finer: int = 0) -> list[float]:
    """Return levels between values, as short as they can be said without touching one.

    Parameters
    ----------
    known : ndarray of float64
    n_finer : int
        So many, evenly by frames; those at `SHARES` if 0.
    """
    distinct = np.unique(known)
    if distinct.size < 2:
        return []
    middles = zip(distinct[:-1].tolist(), distinct[1:].tolist(), strict=True)
    between = np.array([_short(a, b) for a, b in middles])
    shares = np.linspace(0.0, 1.0, n_finer) if n_finer else np.array(SHARES)
    if between.size <= shares.size:
        return [float(b) for b in between]
    at = np.searchsorted(distinct, np.quantile(known, shares, method="lower")).clip(
        0, between.size - 1
    )
    return list(dict.fromkeys(float(b) for b in between[at]))


def _short(low: float, high: float) -> float:
    """Return the finite number of fewest digits that lies between two, about the middle."""
    if math.isinf(low):
        low = high - max(1.0, abs(high)) if math.isfinite(high) else -1.0
    if math.isinf(high):
        high = low + max(1.0, abs(low))
    middle = 0.5 * (low + high)
    for digits in range(1, 17):
        level = float(f"{middle:.{digits}g}")
        if low < level < high:
            return level
    return middle
