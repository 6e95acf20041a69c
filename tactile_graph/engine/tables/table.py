"""Results as a table: a row a frame, or a row a frame and object; each column with its unit."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any, Protocol

import numpy as np

from tactile_graph.engine.blocks.block import Block
from tactile_graph.engine.outcomes.outcome import NO_VALUE, outcome_word
from tactile_graph.engine.outcomes.outcomes import Outcomes
from tactile_graph.engine.tables.block_columns import (
    Cells,
    Part,
    fields_shown,
    lead_cells,
    parts_of,
)
from tactile_graph.engine.tables.columns import (
    Column,
    OutputColumns,
    columns_of,
    columns_of_type,
    values_of,
)
from tactile_graph.engine.tables.image_quantities import ByFrame, Told, told_of
from tactile_graph.engine.tables.rows import free_key, scalars
from tactile_graph.engine.tables.truth import error_names, errors_against, nearest, shape_kind
from tactile_graph.pipeline.graph import Graph
from tactile_graph.pipeline.wiring import arms, public_fields
from tactile_graph.quantities import unit_of
from tactile_graph.steps.signature import list_item
from tactile_graph.vocabulary import error_name, words_and_unit
from tactile_graph.wires.stacks import Stack

Row = dict[str, Any]
LEAD = (
    Column("frame", "", "frame", "", int),
    Column("time_s", "", "time", "s", float),
    Column("label", "", "label", "", str),
)
OBJECT = ("output", "item", "outcome", "type")
_TAKEN = {*OBJECT, *(column.key for column in LEAD)}


class Table(Protocol):
    """A form of table: its columns are known before the first frame."""

    columns: tuple[Column, ...]

    def rows(self, result: Outcomes) -> Iterator[Row]:
        """Yield the rows of a frame, cells by the keys of their columns; an absent one is empty."""

    def of_block(self, block: Block[Any]) -> dict[str, list[Any]]:
        """Return the rows of several frames by columns, None in empty cells."""


def units_of(table: Table, quantities: Collection[str]) -> dict[str, str]:
    """Return the unit of each column of numbers: ``1`` for bare ones, "" where there is no one.

    Parameters
    ----------
    table : Table
    quantities : collection of str
        Of the frames: some columns hold sums of readings.
    """
    found = {c.key: _units(c, quantities) for c in table.columns if _is_number(c.kind)}
    return {key: units[0] if len(units) == 1 else "" for key, units in found.items()}


def without_one_unit(table: Table, quantities: Collection[str]) -> str:
    """Return what to say of columns in which frames of several quantities differ; "" of none."""
    names = [c.key for c in table.columns if len(_units(c, quantities)) > 1]
    frames = " and ".join(sorted(quantities))
    have = "has" if len(names) == 1 else "have"
    return f"frames are in {frames}: {', '.join(names)} {have} no one unit" if names else ""


def without_columns(outputs: Sequence[OutputColumns]) -> str:
    """Return what to say of outputs of which a table holds no value; "" where there are none."""
    names = [o.output for o in outputs if not o.values]
    what = "its type tells no number" if len(names) == 1 else "their types tell no numbers"
    return f"no columns of {', '.join(names)}: {what}; .jsonl holds all" if names else ""


def _units(column: Column, quantities: Collection[str]) -> list[str]:
    by_frame = column.quantities
    if by_frame is None:
        return [column.unit or "1"]
    found = {by_frame[q] for q in quantities if q in by_frame}
    return sorted(unit_of(quantity) if quantity else "" for quantity in found)


def _is_number(kind: type) -> bool:
    return issubclass(kind, int | float | np.number) and not issubclass(kind, bool)


def _lead(result: Outcomes) -> Row:
    frame = result.frame
    return {"frame": frame.index, "time_s": frame.time_s, "label": frame.label}


class FrameTable:
    """A row a frame; of lists only how many items they have.

    What an output holds under a name that the table itself has (``time_s``, ``….outcome``), or
    that is a field of another output, is named ``….value``.

    Parameters
    ----------
    outputs : sequence of OutputColumns
    """

    def __init__(self, outputs: Sequence[OutputColumns]) -> None:
        self._outputs = outputs
        self._names = _names(outputs)
        columns = [*LEAD]
        for output in outputs:
            columns.append(Column(f"{output.output}.outcome", output.output, "outcome", "", str))
            names = self._names[output.output]
            columns += [replace(c, key=names[c.key]) for c in output.values]
            columns += output.errors
        self.columns = tuple(columns)

    def rows(self, result: Outcomes) -> Iterator[Row]:
        """Yield the row of a frame."""
        row = _lead(result)
        for output in self._outputs:
            row[f"{output.output}.outcome"] = outcome_word(result.outcome(output.output))
            values = values_of(result, output)
            names = self._names[output.output]
            row.update({names.get(key) or free_key(key): value for key, value in values.items()})
        yield row

    def of_block(self, block: Block[Any]) -> dict[str, list[Any]]:
        """Return the rows of several frames by columns, None in empty cells."""
        cells = Cells([column.key for column in self.columns], len(block))
        left = np.ones(len(block), np.bool_)
        more = lead_cells(block, cells)
        for part in parts_of(block, [o.output for o in self._outputs]):
            left[part.rows] = not self._put_part(part, cells)
        for row in np.flatnonzero(left | more).tolist():
            cells.put_row(row, next(self.rows(block[row])))
        return cells.columns()

    def _put_part(self, part: Part, cells: Cells) -> bool:
        """Write the cells of frames whose outputs are stacks; return whether all could be."""
        found: dict[str, Sequence[Any]] = {}
        for name, outcomes in part.outcomes.items():
            if isinstance(outcomes, Stack):
                shown = fields_shown(outcomes, name)
                if shown is None:
                    return False
                names = self._names[name]
                found |= {names.get(k) or free_key(k): column for k, column in shown.items()}
                found[f"{name}.outcome"] = ["ok"] * len(part.rows)
            else:
                words = {o: outcome_word(o) for o in set(outcomes)}
                found[f"{name}.outcome"] = [words[o] for o in outcomes]
        for key, column in found.items():
            cells.put(key, part.rows, column)
        return True


def _names(outputs: Sequence[OutputColumns]) -> dict[str, dict[str, str]]:
    """Return, by output, how the table calls what it holds; a field of one may be another."""
    taken: set[str] = set()
    found: dict[str, dict[str, str]] = {}
    for output in sorted(outputs, key=lambda o: len(o.output)):
        names = found[output.output] = {}
        for column in output.values:
            key = free_key(column.key)
            while key in taken:
                key += ".value"
            names[column.key] = key
        taken |= {*names.values()}
    return found


@dataclass(frozen=True)
class _Part:
    """What has rows of its own: an output, or a list in it (``field``)."""

    output: str
    field: str
    item: Any
    """Type of a list's items; None where the output itself is meant."""

    @property
    def name(self) -> str:
        return f"{self.output}.{self.field}" if self.field else self.output


class ObjectTable:
    """A row a frame and object: every item of every list, and every output that is none.

    Columns are named as the fields of what they hold, whichever output that is of: ``x_cm`` of a
    circle and of a contact stand in one column. ``output`` says which output it is (``node.list``
    for a list in it), ``item`` the place in the list, from 1, ``type`` what it is, ``outcome``
    why there is nothing. An output without an object has one row that says so.

    Parameters
    ----------
    pipeline : Graph
    asked : sequence of str
        Outputs or nodes.
    """

    def __init__(self, pipeline: Graph, asked: Sequence[str]) -> None:
        self._parts: dict[str, list[_Part]] = {}
        found: dict[str, Column] = {}
        for name in asked:
            ref = pipeline.outputs.get(name) or pipeline.ref(name)
            kind = pipeline.type_of(ref)
            self._parts[name] = [p for arm in arms(kind) for p in _parts(name, arm)]
            for part in self._parts[name]:
                within = (*ref.path, part.field) if part.field else ref.path
                told = told_of(pipeline, replace(ref, path=within))
                for column in _columns_of_part(part, kind, told):
                    known = found.setdefault(column.key, column)
                    found[column.key] = _shared(known, column)
        lead = [Column(key, "", key, "", int if key == "item" else str) for key in OBJECT]
        self.columns = (*LEAD, *lead, *found.values())

    def rows(self, result: Outcomes) -> Iterator[Row]:
        """Yield a row for each object of a frame."""
        for name, parts in self._parts.items():
            outcome = result.outcome(name)
            if outcome.__class__ in NO_VALUE:
                yield {**_lead(result), "output": name, "outcome": outcome_word(outcome)}
                continue
            for part in parts:
                yield from self._of_part(part, outcome, result)

    def of_block(self, block: Block[Any]) -> dict[str, list[Any]]:
        """Return the rows of several frames by columns, None in empty cells."""
        rows = [row for result in block for row in self.rows(result)]
        return {c.key: [row.get(c.key) for row in rows] for c in self.columns}

    def _of_part(self, part: _Part, value: Any, result: Outcomes) -> Iterator[Row]:
        lead = {**_lead(result), "output": part.name}
        if part.item is None:
            found = _cells(value, result)
            if found:
                yield {**lead, "outcome": "ok", **found}
            return
        items = getattr(value, part.field) if part.field else value
        if items.__class__ in NO_VALUE:
            yield {**lead, "outcome": outcome_word(items)}
            return
        if not len(items):
            yield {**lead, "outcome": "no items"}
        for number, item in enumerate(items, 1):
            there = item.__class__ not in NO_VALUE
            told = {"outcome": "ok", **_cells(item, result)} if there else _lacking(item)
            yield {**lead, "item": number, **told}


def _lacking(item: Any) -> Row:
    word = "failed" if hasattr(item, "error") else "skipped"
    return {"outcome": f"{word}: {item.reason}"}


def _parts(output: str, kind: Any) -> Iterator[_Part]:
    item = list_item(kind)
    if item is not None:
        yield _Part(output, "", item)
        return
    yield _Part(output, "", None)
    for name in getattr(kind, "_fields", ()):
        inner = list_item(public_fields(kind).get(name, Any))
        if inner is not None:
            yield _Part(output, name, inner)


def _columns_of_part(part: _Part, kind: Any, told: Told) -> Iterator[Column]:
    of = kind if part.item is None else part.item
    for arm in arms(of):
        for column in columns_of_type(part.output, arm, told):
            yield replace(column, key=_key(column.key, part.output))
    for error in error_names(of):
        yield Column(error_name(error), part.output, *words_and_unit(error), float, error)


def _key(key: str, output: str) -> str:
    field = key.removeprefix(output).lstrip(".") or "value"
    return f"value.{field}" if field in _TAKEN else field


def _cells(value: Any, result: Outcomes) -> Row:
    row = {_key(key, "v"): cell for key, cell in scalars("v", value).items()}
    if not row:
        return {}
    shape = shape_kind(type(value))
    row["type"] = (shape or type(value)).__name__
    true = nearest(value, result.frame.truth)
    for error, off in errors_against(value, true).items() if true is not None else ():
        row[error_name(error)] = off
    return row


def _shared(known: Column, other: Column) -> Column:
    """Return the column of values of two outputs."""
    quantities = _joined(known.quantities, other.quantities)
    return replace(known, kind=_common(known.kind, other.kind), quantities=quantities)


def _joined(one: ByFrame | None, other: ByFrame | None) -> ByFrame | None:
    if not one or not other:
        return None if one is other is None else {}
    found = {q: {its[q] for its in (one, other) if q in its} for q in {*one, *other}}
    return {q: names.pop() if len(names) == 1 else "" for q, names in found.items()}


def _common(one: type, other: type) -> type:
    both = {one, other}
    if len(both) == 1:
        return one
    if both <= {int, float}:
        return float
    return str


def make_table(pipeline: Graph, asked: Sequence[str], long: bool) -> Table:
    """Return the table of what is asked of a pipeline, a row a frame or (long) an object."""
    names = tuple(asked)
    return ObjectTable(pipeline, names) if long else FrameTable(columns_of(pipeline, names))
