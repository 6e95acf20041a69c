"""Settings as one call holds them: what can be changed in place is copied, so that none reaches on.

A step may well sort, fill or empty a list that it was set to. Were that the list itself, the next
frame, the next run and what is written of the settings would have the changed one.
"""

from __future__ import annotations

import copy
import dataclasses
from collections.abc import Callable
from functools import partial
from typing import Any


def own(value: Any) -> Any:
    """Return a setting's value, copied as far as it can be changed in place; else the same."""
    kind = value.__class__
    if kind in (list, tuple):
        items = [own(item) for item in value]
        if kind is list:
            return items
        same = all(a is b for a, b in zip(items, value, strict=True))
        return value if same else tuple(items)
    if kind is dict:
        return {key: own(item) for key, item in value.items()}
    if kind is not set and not _is_open(value):
        return value
    try:
        return copy.deepcopy(value)
    except Exception:  # a plugin's own record may hold what nobody can copy
        return value


def _is_open(value: Any) -> bool:
    """Return whether a value is a record that can be changed, or holds what can."""
    kind = type(value)
    if not dataclasses.is_dataclass(kind):
        return hasattr(kind, "model_fields")  # one of pydantic's, which is heavy to import
    if not kind.__dataclass_params__.frozen:  # type: ignore[attr-defined]
        return True
    its = (getattr(value, field.name, None) for field in dataclasses.fields(kind))
    return any(own(field) is not field for field in its)


def bound(target: Callable[..., Any], settings: dict[str, Any]) -> Callable[..., Any]:
    """Return a function with its settings filled in, anew for each call where it could change them.

    Parameters
    ----------
    target : callable
    settings : dict
        Nobody else's.
    """
    if not settings:
        return target
    if all(own(value) is value for value in settings.values()):
        return partial(target, **settings)

    def call(*args: Any, **kwargs: Any) -> Any:
        return target(*args, **own(settings), **kwargs)

    return call
