"""Settings that are arrays: a file gives them as lists of numbers."""

from __future__ import annotations

import types
from functools import partial
from typing import Annotated, Any, Union, get_args, get_origin

import numpy as np
from pydantic import BeforeValidator

from tactile_graph.steps.signature import strip


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
    return told if told in (np.float64, np.float32, np.int64, np.int32, np.bool_) else None


def _array(value: Any, dtype: Any) -> Any:
    """Return numbers as an array that nobody can change; anything else as it is."""
    if not isinstance(value, list | tuple):
        return value
    try:
        found = np.array(value)
        if found.dtype.kind in "biuf" and dtype is not None:
            found = found.astype(dtype, casting="same_kind" if found.size else "unsafe")
    except (TypeError, ValueError):
        return value
    if found.dtype.kind not in "biuf":
        return value
    found.setflags(write=False)
    return found
