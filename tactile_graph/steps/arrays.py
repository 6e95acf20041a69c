"""Settings that are arrays: a file gives them as lists of numbers."""

from __future__ import annotations

import math
import types
from functools import partial
from typing import Annotated, Any, Union, get_args, get_origin

import numpy as np
from pydantic import BeforeValidator

from tactile_graph.errors import shown
from tactile_graph.steps.signature import strip

_NUMBERS = {
    np.dtype(code).type for code in "?" + np.typecodes["AllInteger"] + np.typecodes["Float"]
}


def is_array(annotation: Any) -> bool:
    """Return whether a bare type is that of arrays, whatever they hold."""
    return annotation is np.ndarray or get_origin(annotation) is np.ndarray


def with_arrays(annotation: Any) -> Any:
    """Return an annotation by which a list of numbers is taken where an array is meant."""
    bare, metadata = strip(annotation)
    if is_array(bare):
        takes = partial(_array, dtype=_dtype(bare))
        return Annotated[(np.ndarray, BeforeValidator(takes), *metadata)]
    if get_origin(bare) in (Union, types.UnionType) and any(map(is_array, get_args(bare))):
        arms = tuple(map(with_arrays, get_args(bare)))
        either: Any = Union[arms]  # noqa: UP007 -- as many as there are
        return Annotated[(either, *metadata)] if metadata else either
    return annotation


def _dtype(bare: Any) -> Any:
    """Return what an array is to hold, as ``NDArray[np.float64]`` says; None where nothing does."""
    told = next(iter(get_args(get_args(bare)[1])), None) if len(get_args(bare)) > 1 else None
    return told if told in _NUMBERS else None


def _array(value: Any, dtype: Any) -> Any:
    """Return numbers as an array that nobody can change; anything else as it is.

    Raises
    ------
    ValueError
        If the array is to hold numbers of a type that cannot hold one of these.
    """
    if not isinstance(value, list | tuple):
        return value
    try:
        given = np.array(value, dtype=object)
        numbers = [_number(item) for item in given.flat]
    except (TypeError, ValueError):
        return value
    # NumPy takes true and false among numbers for 1 and 0.
    truths = {isinstance(number, bool | np.bool_) for number in numbers}
    if len(truths) > 1 or (dtype is not None and not truths <= {dtype is np.bool_}):
        return value
    if dtype not in (None, np.bool_):
        _refuse_unheld(numbers, dtype)
    found = np.array(numbers, dtype).reshape(given.shape)
    if found.dtype.kind not in "biuf":
        return value
    found.setflags(write=False)
    return found


def _number(item: Any) -> Any:
    """Return an item of a list, as a number where it is one such as YAML's text ``1e-2``."""
    if isinstance(item, str) and "e" in item.lower():
        return float(item)
    if isinstance(item, bool | int | float | np.bool_ | np.integer | np.floating):
        return item
    raise TypeError(f"{item!r} is no number")


def _refuse_unheld(numbers: list[Any], dtype: Any) -> None:
    """Refuse what a type cannot hold: too large numbers, and parts where it is of whole ones."""
    kind = np.dtype(dtype)
    if kind.kind in "iu":
        low, high = np.iinfo(dtype).min, np.iinfo(dtype).max
        wanted = f"whole numbers from {low} to {high}"
        unheld = (n for n in numbers if not low <= n <= high or n != int(n))
    else:
        wanted = f"numbers up to {np.finfo(dtype).max:.3g}"
        unheld = (n for n in numbers if _overflows(n, dtype))
    for number in unheld:
        raise ValueError(f"must be {wanted} ({kind.name}), got {shown(number)}")


def _overflows(number: Any, dtype: Any) -> bool:
    try:
        with np.errstate(over="ignore"):
            return bool(np.isinf(dtype(number))) and number not in (math.inf, -math.inf)
    except OverflowError:  # a whole number of hundreds of digits
        return True
