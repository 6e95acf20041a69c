"""What a block of frames came to, as columns: by arrays where outputs are stacks."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.engine.blocks.block import Block
from tactile_graph.engine.blocks.stacked import at
from tactile_graph.engine.outcomes.outcome import Failed, Skipped
from tactile_graph.engine.outcomes.outcomes import Outcomes
from tactile_graph.wires.stacks import Column, Listed, Rows, Stack, field_of


class Part(NamedTuple):
    """Frames of a block whose outputs are all stacks, or skipped alike.

    Attributes
    ----------
    rows : Rows
        Their places in the block.
    outcomes : mapping of str to Stack or list
        By output: a stack of values, or the outcome of each frame.
    """

    rows: Rows
    outcomes: dict[str, Stack | list[Any]]


def parts_of(block: Block[Any], names: Sequence[str]) -> Iterator[Part]:
    """Yield the parts of a block; frames that are in none are to be taken one by one."""
    for group, (rows, places) in block.together():
        if any(outcome.__class__ is Failed for outcome in group.state):
            continue  # what depends on no frame failed
        outcomes: dict[str, Stack | list[Any]] = {}
        for name in names:
            found = block.outcome_of(group, name)
            if isinstance(found, Stack) and not isinstance(found, Listed):
                outcomes[name] = _at_places(found, places)
            elif found.__class__ is Skipped:
                outcomes[name] = _skipped(found, places)
        if len(outcomes) == len(names) and len(rows):
            yield Part(rows, outcomes)


def _at_places(values: Stack, places: Rows) -> Stack:
    n = len(values)
    whole = len(places) == n and bool((places == np.arange(n)).all())
    return values if whole else values.take(places)


def _skipped(outcome: Skipped, places: Rows) -> list[Any]:
    if at(outcome, 0) is outcome:
        return [outcome] * len(places)
    return [at(outcome, i) for i in places.tolist()]


def fields_shown(values: Stack, output: str) -> dict[str, list[Any]] | None:
    """Return the columns that `scalars` fills for each value, by arrays; None where none tell.

    Parameters
    ----------
    values : Stack
        Of one type.
    output : str
    """
    if isinstance(values, Column):
        return {output: values.values.tolist()}
    shown = getattr(values[0], "columns_shown", ())
    if not shown:
        return None
    return {f"{output}.{name}": list(field_of(values, (name,))) for name in shown}


def known_finite(values: Stack) -> bool:
    """Return whether arrays tell that no number shown of any value is NaN or infinite."""
    if isinstance(values, Column):
        return bool(np.isfinite(values.values).all())
    shown = getattr(values[0], "columns_shown", ())
    columns = [field_of(values, (name,)) for name in shown]
    return bool(columns) and all(isinstance(c, Column) and known_finite(c) for c in columns)


def plain_fields(values: Stack) -> tuple[str, dict[str, list[Any]]] | None:
    """Return the kind and the fields of records that are plain data; None where they are not.

    The fields are those that `as_data` gives, in its order, the kind beside them.
    """
    first = values[0]
    if not dataclasses.is_dataclass(first) or callable(getattr(type(first), "summary", None)):
        return None
    from tactile_graph.engine.tables.rows import as_data

    told = as_data(first)
    if any(isinstance(v, list | dict | str) for k, v in told.items() if k != "kind"):
        return None
    names = [name for name in told if name != "kind"]
    return str(told.get("kind", "")), {n: list(field_of(values, (n,))) for n in names}


class Cells:
    """The cells of a block's rows, a column of Python's own values for each key.

    Parameters
    ----------
    keys : sequence of str
    n : int
    """

    def __init__(self, keys: Sequence[str], n: int) -> None:
        self.n = n
        self._columns: dict[str, Any] = dict.fromkeys(keys)

    def put(self, key: str, rows: Rows, cells: Sequence[Any]) -> None:
        """Write cells of some rows; a key that is no column's is left out."""
        if key not in self._columns:
            return
        if len(rows) == self.n:
            self._columns[key] = list(cells)
            return
        column = self._column(key)
        for row, cell in zip(rows.tolist(), cells, strict=True):
            column[row] = cell

    def put_row(self, row: int, cells: dict[str, Any]) -> None:
        """Write all cells of a row that are told."""
        for key, cell in cells.items():
            if key in self._columns:
                self._column(key)[row] = cell

    def _column(self, key: str) -> list[Any]:
        if self._columns[key] is None:
            self._columns[key] = [None] * self.n
        column: list[Any] = self._columns[key]
        return column

    def columns(self) -> dict[str, list[Any]]:
        """Return the columns, None where a cell is empty."""
        return {key: self._column(key) for key in self._columns}


def lead_cells(block: Block[Outcomes], cells: Cells) -> NDArray[np.bool_]:
    """Write number and time of each frame; return of which more is known than that."""
    frames = block.frames
    every = np.arange(len(block))
    cells.put("frame", every, frames.index.tolist())
    cells.put("time_s", every, frames.times_s)
    cells.put("label", every, [""] * len(block))
    return frames.says_more
