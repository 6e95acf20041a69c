"""What framers hand to assemblers: runs of good units, as arrays rather than one by one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray


@dataclass(slots=True)
class Units:
    """Consecutive good units (packets, lines).

    Parameters
    ----------
    cells : ndarray, shape (k, m)
        The values of each unit, in the wire's own type.
    ends : ndarray of int64, shape (k,)
        Place in the stream just after each unit.
    broken : bool
        True where something between the last run and this one was lost.
    opens : bool
        True where a line that is no data, or a silence, lies before the first unit.
    time, sequence, start, device : ndarray, shape (k,), optional
        The numbers beside the values, where the layout has them.
    doubtful : bool
        True where the units may as well start elsewhere.
    """

    cells: NDArray[Any]
    ends: NDArray[np.int64]
    broken: bool = False
    opens: bool = False
    time: NDArray[Any] | None = None
    sequence: NDArray[Any] | None = None
    start: NDArray[np.int64] | None = None
    device: NDArray[Any] | None = None
    doubtful: bool = False


@dataclass(slots=True)
class Assembled:
    """Whole frames: cells (k, n) in wire order, place of their end, device time, loss before.

    ``doubtful`` tells whether any unit they are made of is.
    """

    cells: NDArray[Any]
    ends: NDArray[np.int64]
    time: NDArray[Any] | None
    gap: NDArray[np.bool_]
    doubtful: bool = False
