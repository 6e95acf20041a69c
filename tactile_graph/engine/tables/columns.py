"""The columns a pipeline's outputs fill, known from their types before the first frame."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, Literal, get_origin

import numpy as np

from tactile_graph.engine.outcomes.notices import untold
from tactile_graph.engine.outcomes.outcome import NO_VALUE
from tactile_graph.engine.outcomes.outcomes import Outcomes
from tactile_graph.engine.tables.image_quantities import UNKNOWN, ByFrame, Told, told_of
from tactile_graph.engine.tables.rows import fields_in_tables, scalars
from tactile_graph.engine.tables.truth import error_names, errors_against, nearest
from tactile_graph.pipeline.graph import Graph
from tactile_graph.pipeline.wiring import arms, field_type, public_fields
from tactile_graph.steps.signature import list_item
from tactile_graph.vocabulary import error_name, words_and_unit


@dataclass(frozen=True, slots=True)
class Column:
    """One scalar of an output.

    ``key`` is its name in files, ``field`` what it is called within the output, without the unit;
    ``error`` is which error it holds, if it holds one. ``quantities`` holds, where its unit is that
    of an image, the image's quantity by that of the frame: "" where nobody knows it.
    """

    key: str
    output: str
    field: str
    unit: str
    kind: type
    error: str = ""
    quantities: ByFrame | None = dataclasses.field(default=None, compare=False)


@dataclass(frozen=True)
class OutputColumns:
    """The columns of one output: its values, and its errors where the truth is known."""

    output: str
    values: tuple[Column, ...]
    errors: tuple[Column, ...]


def columns_of(pipeline: Graph, asked: tuple[str, ...]) -> list[OutputColumns]:
    """Return the columns of each output or node asked for; the same for every frame."""
    found = []
    for name in asked:
        ref = pipeline.outputs.get(name) or pipeline.ref(name)
        kind, told = pipeline.type_of(ref), told_of(pipeline, ref)
        values = {c.key: c for arm in arms(kind) for c in _columns(name, name, arm, told)}
        errors = tuple(_error_column(name, e) for e in error_names(kind))
        found.append(OutputColumns(name, tuple(values.values()), errors))
    return found


def columns_of_type(output: str, kind: Any, told: Told = UNKNOWN) -> list[Column]:
    """Return the columns of an output's values of one type, whose images are in ``told``."""
    return list(_columns(output, output, kind, told))


def _columns(output: str, key: str, kind: Any, told: Told = UNKNOWN) -> Iterator[Column]:
    """Yield the columns `scalars` fills for a value of one type."""
    if get_origin(kind) is Literal:
        kind = str
    if kind is type(None) or kind is None:
        if key == output:
            yield _column(output, key, str)
    elif isinstance(kind, type) and issubclass(kind, bool | int | float | str | np.generic):
        yield _column(output, key, kind)
    elif shown := fields_in_tables(kind):
        for name in shown:
            column = _column(output, f"{key}.{name}", _scalar(field_type(kind, name)))
            yield _in_images_unit(column, kind, name, told)
    elif hasattr(kind, "_fields"):
        yield from _field_columns(output, key, kind, told)
    elif list_item(kind) is not None or isinstance(public_fields(kind).get("count"), type):
        yield _column(output, f"{key}.count", int)


def _in_images_unit(column: Column, kind: Any, name: str, told: Told) -> Column:
    measured = name in getattr(kind, "image_unit", ())
    return replace(column, quantities=told.of(kind)) if measured else column


def _field_columns(output: str, key: str, kind: Any, told: Told) -> Iterator[Column]:
    types, views = public_fields(kind), getattr(kind, "provides", {}).values()
    for name in kind._fields:
        for arm in arms(types.get(name, Any)):
            if list_item(arm) is not None and "count" in kind._fields:
                continue  # the record counts its list itself
            if arm is not type(None):
                inner = told if name in views else Told({}, told.measured)
                for column in _columns(output, f"{key}.{name}", arm, inner):
                    yield _in_images_unit(column, kind, name, told)


def _scalar(kind: Any) -> type:
    found = [str if get_origin(a) is Literal else a for a in arms(kind)]
    scalar = [a for a in found if isinstance(a, type) and a is not type(None)]
    return scalar[0] if scalar else float


def _column(output: str, key: str, kind: type) -> Column:
    name = key.removeprefix(output).lstrip(".")
    return Column(key, output, *words_and_unit(name), kind)


def _error_column(output: str, error: str) -> Column:
    return Column(f"{output}.{error_name(error)}", output, *words_and_unit(error), float, error)


def values_of(result: Outcomes, columns: OutputColumns) -> dict[str, Any]:
    """Return the values of an output's columns for one frame; empty where it has none."""
    outcome = result.outcome(columns.output)
    if outcome.__class__ in NO_VALUE:
        return {}
    try:
        values = scalars(columns.output, outcome)
    except Exception as error:  # a plugin's own code may raise anything
        raise untold(columns.output, "row of numbers", error) from error
    true = nearest(outcome, result.frame.truth) if columns.errors else None
    if true is not None:
        errors = errors_against(outcome, true)
        values.update({c.key: errors.get(c.error) for c in columns.errors})
    return values
