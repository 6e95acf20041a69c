"""Arrays as machine code takes them: whole numbers or usual floats in the machine's byte order."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

NATIVE = frozenset(map(np.dtype, "?bhilqBHILQfd"))
"""Types of numbers; whatever is of others is looked at once more by `native`."""


def native(values: NDArray[Any]) -> NDArray[Any]:
    """Return values in the machine's byte order, half or quadruple precision in double.

    What needs neither is returned as it is.
    """
    dtype = values.dtype
    if dtype.kind == "f" and dtype.itemsize not in (4, 8):
        return values.astype(np.float64)
    return values if dtype.isnative else values.astype(dtype.newbyteorder("="))
