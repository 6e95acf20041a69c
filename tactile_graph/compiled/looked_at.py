"""Arrays looked at before machine code takes them.

numba's own way asks of an array only that it is one and how large its numbers are: it has made sure
of the rest where it finds the code by the arguments' types. Who calls the code itself
(`Kernel.direct`) has not; more dimensions than expected would be written over whatever lies behind.
The look takes some nanoseconds.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.boxing import unbox_array
from numba.core.pythonapi import NativeValue, _unboxers
from numba.np.numpy_support import as_dtype

HEAD = object.__basicsize__
DIMENSIONS, DESCRIPTION = HEAD + 8, HEAD + 40
"""Where numpy's array object holds the number of its dimensions, and what its numbers are."""
KIND = HEAD + 8
"""Where that holds the letter of their kind."""
ORDER, FOREIGN = KIND + 2, {"little": ">", "big": "<"}[sys.byteorder]
"""Where that holds the sign of their bytes' order, and that of the order no machine code takes."""
BYTE, COUNT, PLACE = ir.IntType(8), ir.IntType(32), ir.IntType(64)


@contextmanager
def arrays_looked_at() -> Iterator[None]:
    """Let what is compiled meanwhile look at each array that Python gives it."""
    before = _unboxers.functions[types.Array]
    _unboxers.functions[types.Array] = _looked_at
    try:
        yield
    finally:
        _unboxers.functions[types.Array] = before


def _looked_at(kind: Any, given: Any, c: Any) -> Any:
    """Return an array as machine code has it; an error where it is not of its type."""
    builder = c.builder
    array = cgutils.alloca_once(builder, c.context.get_value_type(kind), zfill=True)
    failed = cgutils.alloca_once_value(builder, cgutils.true_bit)
    n = builder.load(_at(builder, given, DIMENSIONS, COUNT))
    with builder.if_else(builder.icmp_signed("==", n, COUNT(kind.ndim))) as (right, wrong):
        with right:
            found = unbox_array(kind, given, c)
            builder.store(found.value, array)
            builder.store(found.is_error, failed)
            with builder.if_then(builder.not_(found.is_error)):
                same = _of_kind(builder, given, as_dtype(kind.dtype))
                if kind.layout == "C":
                    same = builder.and_(same, _in_order(kind, found.value, c))
                with builder.if_then(builder.not_(same), likely=False):
                    c.context.nrt.decref(builder, kind, found.value)
                    builder.store(cgutils.true_bit, failed)
                    _refused(kind, c)
        with wrong:
            _refused(kind, c)
    return NativeValue(builder.load(array), is_error=builder.load(failed))


def _refused(kind: Any, c: Any) -> None:
    layout = {"C": " in order of memory,"}.get(kind.layout, "")
    numbers = f"{as_dtype(kind.dtype)}{layout} in this machine's byte order"
    what = f"an array of {kind.ndim} dimensions of {numbers}"
    c.pyapi.err_set_string("PyExc_TypeError", f"this machine code takes {what} here, got another")


def _at(builder: Any, thing: Any, offset: int, kind: Any) -> Any:
    place = builder.gep(builder.bitcast(thing, ir.PointerType(BYTE)), [PLACE(offset)])
    return builder.bitcast(place, ir.PointerType(kind))


def _of_kind(builder: Any, given: Any, dtype: np.dtype[Any]) -> Any:
    """Return whether an array's numbers are of a kind: whole, signed, floating, yes or no.

    And in the machine's byte order: by read-only arrays of another one numba finds the same code.
    """
    description = builder.load(_at(builder, given, DESCRIPTION, ir.PointerType(BYTE)))
    letter = builder.load(_at(builder, description, KIND, BYTE))
    order = builder.load(_at(builder, description, ORDER, BYTE))
    return builder.and_(
        builder.icmp_unsigned("==", letter, BYTE(ord(dtype.kind))),
        builder.icmp_unsigned("!=", order, BYTE(ord(FOREIGN))),
    )


def _in_order(kind: Any, value: Any, c: Any) -> Any:
    """Return whether an array's numbers lie one behind the other."""
    builder = c.builder
    array = c.context.make_array(kind)(c.context, builder, value)
    shape = cgutils.unpack_tuple(builder, array.shape, kind.ndim)
    strides = cgutils.unpack_tuple(builder, array.strides, kind.ndim)
    expected, right = array.itemsize, builder.icmp_signed("==", array.nitems, PLACE(0))
    each = cgutils.true_bit
    for size, stride in zip(reversed(shape), reversed(strides), strict=True):
        single = builder.icmp_signed("<=", size, PLACE(1))
        each = builder.and_(each, builder.or_(single, builder.icmp_signed("==", stride, expected)))
        expected = builder.mul(expected, size)
    return builder.or_(right, each)
