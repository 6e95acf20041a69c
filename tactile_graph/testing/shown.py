"""Find what an answer says of itself that cannot be had: columns, drawing, notices, errors."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from inspect import signature as parameters_of
from typing import Any

import numpy as np

from tactile_graph.draw.display import display_list
from tactile_graph.engine.outcomes.notices import ASSUMED, NOTICE, VALUE, said
from tactile_graph.engine.tables.rows import as_data, scalars
from tactile_graph.engine.tables.truth import errors_against, shape_kind
from tactile_graph.errors import did_you_mean, text_of
from tactile_graph.steps.signature import Signature
from tactile_graph.wires import TrueObject


def unshown(value: Any) -> str:
    """Return what of an answer cannot be shown to people, and why; "" where all can."""
    for what, attempt in _shows(value):
        try:
            attempt()
        except Exception as error:  # a plugin's own code may raise anything
            return f"its {what} cannot be had: {type(error).__name__}: {_line(error)}"
    return ""


def unsaid(signature: Signature, inputs: Mapping[str, Any], value: Any) -> str:
    """Return what is wrong with the notice of a step for an answer; "" where nothing is."""
    say = getattr(signature.target, NOTICE, None)
    if say is None:
        return ""
    ports = [p.name for p in signature.ports]
    try:
        for name in parameters_of(say).parameters:
            if name not in (*ports, VALUE):
                hint = did_you_mean(name, ports)
                return f"its notice asks for {name!r}, which is none of its ports{hint}"
        said(say, value, partial(_all_of, inputs))
    except Exception as error:  # a plugin's own code may raise anything
        return f"its notice cannot be had: {type(error).__name__}: {_line(error)}"
    return ""


def _all_of(inputs: Mapping[str, Any], names: tuple[str, ...]) -> dict[str, Any] | None:
    return {n: inputs[n] for n in names} if all(n in inputs for n in names) else None


def _shows(value: Any) -> Iterator[tuple[str, Callable[[], Any]]]:
    yield "columns", lambda: scalars("value", value)
    yield "summary", lambda: as_data(value, full=False)
    yield ASSUMED, lambda: getattr(value, ASSUMED, "")
    yield "drawing", lambda: _drawn(value)
    for item in value if isinstance(value, list | tuple) else (value,):
        if shape_kind(type(item)) is not None:
            yield "error against the truth", partial(_measured, item)


def _drawn(value: Any) -> None:
    for record in display_list(value):
        xy = np.asarray(getattr(record, "xy_cm", np.zeros((0, 2))))
        if xy.ndim != 2 or xy.shape[1] != 2:
            raise ValueError(f"places have the shape {xy.shape}, (places, 2) is needed")
        if len(xy) and not np.isfinite(xy).any():
            raise ValueError(f"none of its {len(xy)} places is a number")


def _measured(shape: Any) -> None:
    """Hold a shape against itself: it is not off."""
    try:
        true = TrueObject(shape)
    except ValueError:  # without a place or a size, no object can lie so
        return
    for name, off in errors_against(shape, true).items():
        if math.isfinite(off) and abs(off) > 1e-9:
            raise ValueError(f"{name} of a shape against itself is {off:g}, not 0")


def _line(error: Exception) -> str:
    return " ".join(text_of(error).split())
