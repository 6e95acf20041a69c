"""Arrays and named tuples that machine code gives back, made without a line of Python.

numba's own way looks their classes up, and makes each named tuple, by Python code. A signal that
comes then raises in there, and machine code takes what was not made for an object: the process ends
with a segmentation fault in place of Ctrl-C's. Without Python code it waits until the answer is
there. That also spares about a microsecond for each.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from llvmlite import ir
from numba.core import cgutils
from numba.core.boxing import box_tuple
from numba.core.pythonapi import _boxers
from numba.core.types import Array
from numba.core.types.containers import NamedTuple, NamedUniTuple
from numba.np.numpy_support import as_dtype


@contextmanager
def given_back_by_c() -> Iterator[None]:
    """Let what is compiled meanwhile give arrays and named tuples back so."""
    before = {kind: _boxers.functions[kind] for kind in _MADE}
    _boxers.functions.update(_MADE)
    try:
        yield
    finally:
        _boxers.functions.update(before)


def _named_tuple(kind: Any, value: Any, c: Any) -> Any:
    """Return a named tuple as Python has it."""
    items = box_tuple(kind, value, c)
    made = c.pyapi.call_function_objargs(_kept(_NEW, c), (_kept(kind.instance_class, c), items))
    c.pyapi.decref(items)
    return made


def _array(kind: Any, value: Any, c: Any) -> Any:
    """Return an array as Python has it."""
    api, count = c.pyapi, ir.IntType(32)
    takes = [api.voidptr, api.pyobj, count, count, api.pyobj]
    make = api._get_function(
        ir.FunctionType(api.pyobj, takes), name="NRT_adapt_ndarray_to_python_acqref"
    )
    given = c.builder.bitcast(cgutils.alloca_once_value(c.builder, value), api.voidptr)
    n, writeable = count(kind.ndim), count(int(kind.mutable))
    numbers = _kept(as_dtype(kind.dtype), c)
    made = c.builder.call(make, [given, _kept(kind.box_type, c), n, writeable, numbers])
    c.context.nrt.decref(c.builder, kind, value)
    return made


def _kept(thing: Any, c: Any) -> Any:
    """Return a thing that the machine code keeps for as long as it is there."""
    return c.env_manager.read_const(c.env_manager.add_const(thing))


_NEW = tuple.__new__
_MADE: dict[Any, Any] = {
    NamedTuple: _named_tuple,
    NamedUniTuple: _named_tuple,
    Array: _array,
}
