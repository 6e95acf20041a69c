"""Frozen records changed, of which a frame takes several."""

from __future__ import annotations

from typing import Any, TypeVar

Record = TypeVar("Record")


def changed(record: Record, **parts: Any) -> Record:
    """Return what `dataclasses.replace` returns, in a quarter of the time.

    Parameters
    ----------
    record : frozen dataclass
        Without slots, and without a ``__post_init__``, which would not be called.
    **parts
        Fields that become others; nobody looks whether there are such.

    Notes
    -----
    What cached properties have kept is left behind, as it may hang on what is changed.
    """
    new: Record = object.__new__(type(record))
    before, own = vars(record), vars(new)
    for name in record.__dataclass_fields__:  # type: ignore[attr-defined]
        own[name] = before[name]
    own.update(parts)
    return new
