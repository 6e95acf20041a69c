"""The clock of `time.perf_counter_ns`, read by machine code; imports numba."""

from __future__ import annotations

import time
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

_MONOTONIC = getattr(time, "CLOCK_MONOTONIC", 1)


@intrinsic
def now_ns(typing_context: Any) -> Any:
    """Return nanoseconds of the clock that never goes back, as Python's on Linux."""

    def made(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        whole = ir.IntType(64)
        reading = cgutils.alloca_once(builder, ir.ArrayType(whole, 2))
        function = cgutils.get_or_insert_function(
            builder.module,
            ir.FunctionType(ir.IntType(32), [ir.IntType(32), ir.PointerType(whole)]),
            "clock_gettime",
        )
        place = builder.bitcast(reading, ir.PointerType(whole))
        builder.call(function, [ir.Constant(ir.IntType(32), _MONOTONIC), place])
        seconds = builder.load(place)
        nanoseconds = builder.load(builder.gep(place, [ir.Constant(whole, 1)]))
        return builder.add(builder.mul(seconds, ir.Constant(whole, 10**9)), nanoseconds)

    return types.int64(), made
