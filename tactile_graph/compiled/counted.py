"""References to arrays, counted by an entry's own code.

Machine code counts who holds an array: numba calls a function for each row that loops take and for
each array that they hand on, and that function locks the count, since threads might share it. In
loops over rows that takes a sixth of the time. No thread shares the counts of an entry: numba wraps
each array that Python gives anew for each call, what the entry makes nobody else knows yet, and
what it gives back Python counts itself. So once numba has left out the counts that it can prove
needless, the others are taken in, without a lock, and the optimiser sees through them.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any

from llvmlite import binding
from numba import types
from numba.core.types.containers import BaseTuple
from numba.core.types.misc import NoneType

CALLED = re.compile(r"^(?!define|declare)(.*)@NRT_(incref|decref)\(", re.MULTILINE)
"""A call of the function that counts one more, or one less."""

ENDS = "NRT_MemInfo_call_dtor"
"""What frees an array that nobody holds."""

COUNTS = f"""
define internal void @counted_incref(ptr %array) alwaysinline {{
  %none = icmp eq ptr %array, null
  br i1 %none, label %done, label %some
some:
  %count = load i64, ptr %array, align 8
  %more = add i64 %count, 1
  store i64 %more, ptr %array, align 8
  br label %done
done:
  ret void
}}

define internal void @counted_decref(ptr %array) alwaysinline {{
  %none = icmp eq ptr %array, null
  br i1 %none, label %done, label %some
some:
  %count = load i64, ptr %array, align 8
  %less = sub i64 %count, 1
  store i64 %less, ptr %array, align 8
  %last = icmp eq i64 %less, 0
  br i1 %last, label %end, label %done
end:
  call void @{ENDS}(ptr %array)
  br label %done
done:
  ret void
}}
"""


def are_its_own(arguments: Iterable[types.Type]) -> bool:
    """Return whether an entry that takes such arguments shares no count with another thread.

    Arrays, numbers and tuples of them do not; a list of numba's own is one object for all.
    """
    return all(
        are_its_own(kind)
        if isinstance(kind, BaseTuple)
        else isinstance(kind, types.Array | types.Number | types.Boolean | NoneType)
        for kind in arguments
    )


def taken_in(module: Any) -> Any:
    """Return a module of LLVM that counts by itself what it counted by calls."""
    text, n = CALLED.subn(r"\1@counted_\2(", str(module))
    if n == 0:
        return module
    if f"@{ENDS}(" not in text:
        text += f"\ndeclare void @{ENDS}(ptr)\n"
    made = binding.parse_assembly(text + COUNTS)
    made.name = module.name
    return made
