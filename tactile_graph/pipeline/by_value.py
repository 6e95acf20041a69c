"""Values of any class as text that tells two of them apart, whatever their own text leaves out.

A text of what is made of records and of Python's own values is the one that Python gives it.
"""

from __future__ import annotations

import dataclasses
import sys
import uuid
from collections import defaultdict
from collections.abc import Hashable, Iterable, Mapping
from datetime import date, datetime, time, timedelta
from decimal import Decimal
from enum import Enum
from fractions import Fraction
from functools import cached_property
from itertools import count
from pathlib import PurePath
from types import BuiltinFunctionType, FunctionType, MappingProxyType, ModuleType
from typing import Any

_TELLING = (
    type(None), bool, int, float, complex, str, bytes, bytearray, range, date, timedelta, Decimal,
    Fraction, uuid.UUID,
)  # fmt: skip
"""Classes whose texts hold all of a value."""
_TIMES = (datetime, time)
_untold: dict[int, tuple[object, str]] = {}
"""What cannot be looked into, and its text; kept, so that nothing else gets its id."""
_numbers: defaultdict[str, count[int]] = defaultdict(count)


def text_by_value(value: Any) -> str:
    """Return a text that values share only if they are of one class and hold the same."""
    if isinstance(value, Enum):
        return str(Enum.__str__(value))
    if type(value) in _TELLING or _is_path(value):
        return str(value)
    if type(value) in _TIMES and value.tzinfo is None and not value.fold:
        return str(value)
    try:
        return _told(value)
    except RecursionError:  # it holds itself
        return _of_its_own(value)


def _told(value: Any) -> str:
    """Return what `repr` gives for what is made of records and of Python's own values."""
    if isinstance(value, Enum):
        return Enum.__repr__(value)
    if type(value) in _TELLING or _is_path(value):
        return repr(value)
    if type(value) in _TIMES:
        zone = value.tzinfo
        return repr(value) if zone is None else f"{value.replace(tzinfo=None)!r} {_told(zone)}"
    if type(value) in (list, tuple, dict, set, frozenset, MappingProxyType):
        return _collection(value)
    if isinstance(value, type | FunctionType | BuiltinFunctionType):
        return _named(value)
    if type(value).__module__ == "numpy" and hasattr(value, "tolist"):
        return _array(value)
    if isinstance(value, tuple) and hasattr(value, "_fields"):
        return _record(type(value), dict(zip(value._fields, value, strict=True)))
    if dataclasses.is_dataclass(value):
        own = _kept(type(value), getattr(value, "__dict__", {}))
        fields = {f.name: getattr(value, f.name, None) for f in dataclasses.fields(value)}
        return _record(type(value), fields | own)
    if hasattr(type(value), "model_fields"):  # of pydantic: its pickle holds what was given, too
        own = _kept(type(value), vars(value))
        for more in ("__pydantic_extra__", "__pydantic_private__"):
            own |= getattr(value, more, None) or {}
        return _record(type(value), own)
    return _pickled(value)


def _collection(value: Any) -> str:
    kind = type(value)
    if kind is MappingProxyType:
        return f"mappingproxy({_told(dict(value))})"
    if kind is dict:
        return "{" + _joined(f"{_told(k)}: {_told(v)}" for k, v in value.items()) + "}"
    texts = [_told(v) for v in value]
    if kind is list:
        return f"[{_joined(texts)}]"
    if kind is tuple:
        return f"({texts[0]},)" if len(texts) == 1 else f"({_joined(texts)})"
    text = "{" + _joined(sorted(texts)) + "}"  # the same under every hash seed
    return text if kind is set and texts else f"{kind.__name__}({text if texts else ''})"


def _array(value: Any) -> str:
    """Return what an array or one number of NumPy holds; what it says itself is shortened."""
    if isinstance(value, Hashable):  # one number
        return repr(value)
    return f"array({_told(value.tolist())}, dtype={value.dtype.descr}, shape={value.shape})"


def _record(kind: type, parts: Mapping[str, Any]) -> str:
    return f"{kind.__qualname__}({_joined(f'{name}={_told(v)}' for name, v in parts.items())})"


def _joined(texts: Iterable[str]) -> str:
    return ", ".join(texts)


def _kept(kind: type, names: Mapping[str, Any]) -> dict[str, Any]:
    """Return what an object keeps under names, but for what it has worked out from the others."""
    worked_out = {n for n in names if isinstance(getattr(kind, n, None), cached_property)}
    return {name: part for name, part in names.items() if name not in worked_out}


def _named(value: Any) -> str:
    """Return the name of a class or function, where it can be found by it."""
    of = getattr(value, "__self__", None)
    if of is not None and not isinstance(of, ModuleType):  # a method of a class in C
        return f"{_told(of)}.{value.__name__}"
    module, name = value.__module__ or "builtins", value.__qualname__
    found: Any = sys.modules.get(module)
    for part in name.split("."):
        found = getattr(found, part, None)
    if found is not value:
        return _of_its_own(value)
    return f"{'__main__' if module == '__mp_main__' else module}.{name}"  # a worker's name of it


def _pickled(value: Any) -> str:
    """Return what pickle would keep of an object."""
    try:
        made = value.__reduce_ex__(4)
    except Exception:  # whatever a class that is not to be pickled raises
        return _of_its_own(value)
    if isinstance(made, str):
        return made
    function, given, state, *items = (*made, None)[:5]
    if isinstance(state, dict):
        state = _kept(type(value), state)
    items = [item if item is None else list(item) for item in items]
    return f"{_told(function)}({_told(given)}, {_told(state)}, {_told(items)})"


def _of_its_own(value: Any) -> str:
    """Return a text that nothing else has, and that a run which makes the same again repeats.

    Seeds of random numbers hang on it: it counts those of a name as they are first asked for.
    """
    known = _untold.get(id(value))
    if known is None:
        name = str(getattr(value, "__qualname__", type(value).__qualname__))
        known = _untold[id(value)] = value, f"<{name} {next(_numbers[name])}>"
    return known[1]


def _is_path(value: Any) -> bool:
    return isinstance(value, PurePath) and type(value).__module__.startswith("pathlib")
